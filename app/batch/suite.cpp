#include "app/batch/suite.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/batch/golden_file.h"
#include "app/batch/junit.h"
#include "app/batch/seed_list.h"
#include "app/measures/metrics.h"
#include "app/provenance/compare.h"
#include "app/provenance/differing_pixel.h"
#include "app/provenance/manifest.h"
#include "app/support/job_pool.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/state/pile_state_file.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/output_files.h"
#include "scripting/suite_script.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

// One mission with one seed.
struct Case {
  const SuiteRun* run;
  std::string name;    // "heap" or "heap/seed_3"
  std::string folder;  // of its dataset
  CaseResult result;
};

// What a run is held to from now on.
struct Found {
  std::string name;  // of the case
  GoldenHashes hashes;
  GoldenDetails details;
};

class Suite {
 public:
  explicit Suite(const SuiteRequest& request)
      : request_(request),
        script_(load_suite(request.suite, metric_names())),
        stem_(fs::path(request.suite).stem().string()),
        out_(request.out.empty() ? "out/" + stem_ : request.out),
        golden_(fs::path(request.suite).replace_extension(".golden.json").string()),
        shape_(choose_job_shape(request.jobs, request.options.threads)) {
    allow_results(out_);
    if (!request.against.empty()) check_against();
    for (const std::string& name : request.only) check_known(name);
    for (std::size_t i = 0; i < script_.runs.size(); ++i)
      if (wanted(script_.runs[i].name)) add_cases(script_.runs[i], i);
  }

  ExitCode run() {
    stop_on_signals();
    run_jobs(make_jobs(), shape_.at_once, [this](std::size_t i, const JobResult& result) {
      judge(cases_[i], result);
      return true;
    });
    if (stop_requested()) throw Stopped("stopped by a signal; the suite is not finished");
    if (request_.update) update_golden();
    write_junit();
    return report();
  }

 private:
  bool wanted(const std::string& name) const {
    const auto& only = request_.only;
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
  }

  void check_known(const std::string& name) const {
    std::vector<std::string> names;
    for (const SuiteRun& run : script_.runs) {
      if (run.name == name) return;
      names.push_back(run.name);
    }
    const std::string near = nearest_name(name, names);
    throw InputError({request_.suite, 0, "--only", "no run has the name `" + name + "`", "", "",
                      near.empty() ? "" : "did you mean `" + near + "`?"});
  }

  void add_cases(const SuiteRun& run, std::size_t index) {
    if (run.seeds.empty()) {
      cases_.push_back({&run, run.name, out_ + "/" + run.name, {}});
      seeds_.emplace_back();
      return;
    }
    const std::string key = "runs[" + std::to_string(index + 1) + "].seeds";
    for (const std::uint64_t seed : parse_seeds(run.seeds, key)) {
      const std::string name = run.name + "/seed_" + std::to_string(seed);
      cases_.push_back({&run, name, out_ + "/" + name, {}});
      seeds_.push_back(std::to_string(seed));
    }
  }

  std::vector<Job> make_jobs() const {
    std::vector<Job> jobs;
    const fs::path beside = fs::path(request_.suite).parent_path();
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      const Case& c = cases_[i];
      Job job;
      job.log = c.folder + ".log";
      job.arguments = {c.run->pile_only ? "settle" : "run",
                       (beside / c.run->mission).string(),
                       "--out",
                       c.folder,
                       "--force",
                       "--quiet",
                       "--threads",
                       std::to_string(shape_.threads)};
      if (!c.run->pile_only && !request_.options.device.empty())
        job.arguments.insert(job.arguments.end(), {"--device", request_.options.device});
      if (!seeds_[i].empty()) job.arguments.insert(job.arguments.end(), {"--seed", seeds_[i]});
      for (const std::string& text : c.run->set)
        job.arguments.insert(job.arguments.end(), {"--set", text});
      make_output_folder(fs::path(c.folder).parent_path().string());
      jobs.push_back(std::move(job));
    }
    return jobs;
  }

  void judge(Case& c, const JobResult& ended) {
    c.result.name = c.name;
    c.result.seconds = ended.seconds;
    const bool finished =
        ended.exit_code == int(ExitCode::done) || ended.exit_code == int(ExitCode::did_not_settle);
    if (finished) {
      const std::string path = c.folder + "/manifest.json";
      judge_manifest(c, manifest_from_json(read_whole_file(path), path));
    } else {
      c.result.error = "the run failed with exit code " + std::to_string(ended.exit_code);
      c.result.log = tail_of_log(c.folder + ".log", 20);
    }
    print(c.result);
  }

  void judge_manifest(Case& c, const Manifest& manifest) {
    const auto& names = metric_names();
    bool settled_limited = false;
    for (std::size_t m = 0; m < names.size(); ++m) {
      if (!c.run->expect[m]) continue;
      settled_limited |= names[m].first == "settled";
      judge_metric(names[m].first, *c.run->expect[m], manifest, c.result);
    }
    if (!settled_limited && !manifest.pile.settled)
      c.result.failures.push_back("the pile did not settle (`settled = { 0, 1 }` allows it)");
    const GoldenHashes found = golden_hashes(manifest, c.run->golden);
    const PileState pile = load_pile_state(c.folder + "/pile.bin");
    if (request_.update) {
      found_.push_back({c.name, found, golden_details(manifest, pile, c.run->golden)});
      return;
    }
    const std::vector<std::string> apart = golden_.compare(c.name, found);
    c.result.failures.insert(c.result.failures.end(), apart.begin(), apart.end());
    if (apart.empty()) return;
    for (std::string& sentence : golden_.find_first(c.name, pile, manifest.frames))
      c.result.failures.push_back(std::move(sentence));
    if (!request_.against.empty()) compare_with_earlier(c, manifest, pile);
  }

  void check_against() const {
    allow_results(request_.against);
    std::error_code failed;
    if (!fs::is_directory(request_.against, failed))
      throw InputError({request_.against, 0, "--against", "no such folder", "the output folder of an earlier run of the suite", "", ""});
    if (fs::equivalent(request_.against, out_, failed))
      throw InputError({request_.against, 0, "--against", "this run is written there, over the earlier one", "another folder",
                        "", "set --out"});
  }

  // By the dataset that an earlier run of the suite left: the number of the piece, the pixel of the frame.
  void compare_with_earlier(Case& c, const Manifest& manifest, const PileState& pile) const {
    const std::string earlier = request_.against + "/" + fs::relative(c.folder, out_).string();
    std::error_code failed;
    if (!fs::exists(earlier + "/manifest.json", failed)) {
      c.result.failures.push_back("no earlier dataset in " + earlier);
      return;
    }
    const Manifest was = manifest_from_json(read_whole_file(earlier + "/manifest.json"), earlier);
    const std::string piece = describe_difference(load_pile_state(earlier + "/pile.bin"), pile);
    if (!piece.empty()) c.result.failures.push_back("against " + earlier + ": " + piece);
    const FrameDifference apart = find_difference(was.frames, manifest.frames);
    if (apart.why.empty()) return;
    c.result.failures.push_back("against " + earlier + ": " + apart.why + describe_pixel(apart, was.frames, earlier, c.folder));
  }

  static void judge_metric(const std::string& name, const NumberPair& limits,
                           const Manifest& manifest, CaseResult& result) {
    const auto found = manifest.metrics.find(name);
    if (found == manifest.metrics.end())
      result.failures.push_back(name + " is expected, but this run has none" +
                                (name.rfind("void_", 0) == 0 ? " (`voids.on = true`)" : ""));
    else if (!(found->second >= limits[0] && found->second <= limits[1]))
      result.failures.push_back(name + " is " + exact_text(found->second) + ", not from " +
                                exact_text(limits[0]) + " to " + exact_text(limits[1]));
  }

  void print(const CaseResult& result) const {
    if (request_.options.quiet && result.passed()) return;
    print_out("%s %s (%.1f s)\n", result.passed() ? "ok  " : "FAIL", result.name.c_str(),
              result.seconds);
    if (!result.error.empty())
      print_out("     %s\n%s\n", result.error.c_str(), result.log.c_str());
    for (const std::string& sentence : result.failures) print_out("     %s\n", sentence.c_str());
    std::fflush(stdout);
  }

  // In the order of the suite, whichever ended first. Runs that failed keep what they had.
  void update_golden() {
    std::vector<std::string> diff, names;
    std::sort(found_.begin(), found_.end(),
              [](const Found& a, const Found& b) { return a.name < b.name; });
    for (const Found& f : found_)
      for (const std::string& line : golden_.update(f.name, f.hashes, f.details)) diff.push_back(line);
    for (const Case& c : cases_) names.push_back(c.name);
    if (request_.only.empty())
      for (const std::string& line : golden_.keep_only(names)) diff.push_back(line);
    golden_.save();
    for (const std::string& line : diff) print_out("%s\n", line.c_str());
    if (diff.empty()) print_out("the golden hashes are as they were\n");
  }

  void write_junit() const {
    if (request_.junit.empty()) return;
    std::vector<CaseResult> results;
    for (const Case& c : cases_) results.push_back(c.result);
    write_text_file(request_.junit, make_junit(stem_, results));
  }

  ExitCode report() const {
    const auto passed = std::count_if(cases_.begin(), cases_.end(),
                                      [](const Case& c) { return c.result.passed(); });
    print_out("%d of %zu passed\n", int(passed), cases_.size());
    return std::size_t(passed) == cases_.size() ? ExitCode::done : ExitCode::differs;
  }

  const SuiteRequest& request_;
  SuiteScript script_;
  std::string stem_, out_;
  GoldenFile golden_;
  JobShape shape_;
  std::vector<Case> cases_;
  std::vector<std::string> seeds_;  // one per case; empty: the mission's own
  std::vector<Found> found_;
};

}  // namespace

ExitCode run_suite(const SuiteRequest& request) { return Suite(request).run(); }

}  // namespace rubble
