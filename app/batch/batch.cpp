#include "app/batch/batch.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "app/assets/asset_library.h"
#include "app/batch/batch_folder.h"
#include "app/batch/seed_list.h"
#include "app/control/robot_control.h"
#include "app/estimate/disk_estimate.h"
#include "app/estimate/preview.h"
#include "app/mission/resolved_mission.h"
#include "app/provenance/folder_lock.h"
#include "app/provenance/provenance.h"
#include "app/support/build_info.h"
#include "app/support/job_pool.h"
#include "app/support/print.h"
#include "app/support/progress.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kMostListed = 20;  // variants of a preview

struct Tally {
  std::size_t ended = 0, failed = 0, not_settled = 0, done_before = 0;
  std::size_t elsewhere = 0;  // another process made or makes them
  std::uint64_t bytes = 0;  // of the seeds that ended well in this process
};

struct BatchRun {
  std::uint64_t seed = 0;
  std::size_t variant = 0;
  std::string name;  // of its folder
};

class Batch {
 public:
  explicit Batch(const BatchRequest& request)
      : request_(request),
        all_(parse_seeds(request.seeds, "--seeds")),
        sweep_(make_sweep(request.vary, request.samples)),
        shape_(choose_job_shape(request.jobs, request.of.options.threads)),
        folder_(request.of.out.empty()
                    ? "out/" + fs::path(request.of.mission).stem().string() + "_batch"
                    : request.of.out),
        progress_(choose_progress_style(request.of.options.quiet)) {
    check_overrides();
    const Shard shard = request.shard.empty() ? Shard{} : parse_shard(request.shard);
    const std::uint64_t variants = sweep_.variants.size();
    for (std::size_t variant = 0; variant < variants; ++variant)
      for (const std::uint64_t seed : all_)
        if (shard.has(seed * variants + variant))
          mine_.push_back({seed, variant, sweep_.run_name(variant, std::to_string(seed))});
  }

  ExitCode run() {
    check_mission();
    if (request_.of.preview) return show_preview();
    folder_.open(describe());
    if (request_.index_only) {
      write_index();
      return report();
    }
    make_jobs();
    check_disk(estimate_, "estimated");
    progress_.start("batch");
    run_jobs(jobs_, shape_.at_once,
             [this](std::size_t i, const JobResult& result) { return note(i, result); });
    write_index();
    progress_.finish(words());
    return report();
  }

 private:
  void check_overrides() const {
    for (const std::string& text : request_.of.overrides) {
      if (text.rfind("seed=", 0) == 0)
        throw InputError({"", 0, "--set", "--seeds gives the seeds of a batch", "a key besides the seed", "\"" + text + "\"",
                          "leave it out"});
      for (const std::string& key : sweep_.keys)
        if (text.rfind(key + "=", 0) == 0)
          throw InputError({"", 0, "--set", "--vary gives the values of " + key, "a key that is not varied", "\"" + text + "\"",
                            "leave it out, or add its value to those of --vary"});
    }
  }

  // What every seed has in common is read once, so that a mistake is not found a thousand times; of
  // what varies, every value once.
  void check_mission() {
    MissionOptions options = mission_options(request_.of);
    options.seed = all_.front();
    std::set<std::string> seen;
    for (std::size_t variant = 0; variant < sweep_.variants.size(); ++variant) {
      const std::vector<std::string> values = sweep_.overrides(variant);
      bool is_new = variant == 0;
      for (const std::string& value : values) is_new = seen.insert(value).second || is_new;
      if (!is_new) continue;
      MissionOptions varied = options;
      varied.overrides.insert(varied.overrides.end(), values.begin(), values.end());
      const Mission mission = load_mission(request_.of.mission, varied);
      const AssetLibrary assets = load_assets(mission, request_.of.asset_packs);
      print_warnings(assets.warnings);
      check_robot_models(mission.scenario, assets, mission.script);
      estimate_ = std::max(estimate_, estimate_bytes(mission.scenario, assets, request_.pile_only));
      if (request_.of.preview) {
        const RunKind kind = request_.pile_only ? RunKind::settle : RunKind::run;
        previews_.push_back(preview_run(kind, mission.scenario, assets, folder_.path()));
      }
      if (variant == 0) describe_mission(mission, assets, options);
    }
  }

  // Each new value was looked at once: the longest time and the largest size of these stand for all runs.
  ExitCode show_preview() const {
    const std::size_t runs = mine_.size();
    print_out("%zu runs: %zu seeds, %zu variants%s; %d at once on %d threads each\n", runs, all_.size(),
              sweep_.variants.size(), request_.shard.empty() ? "" : (", shard " + request_.shard).c_str(), shape_.at_once,
              shape_.threads);
    for (std::size_t variant = 0; sweep_.varies() && variant < sweep_.variants.size(); ++variant) {
      if (variant == kMostListed) {
        print_out("... and %zu variants more\n", sweep_.variants.size() - variant);
        break;
      }
      std::string line = "v" + std::to_string(variant + 1) + ":";
      for (const std::string& value : sweep_.overrides(variant)) line += " " + value;
      print_out("%s\n", line.c_str());
    }
    const auto less = [](const RunPreview& a, const RunPreview& b) {
      return std::make_pair(a.seconds.value_or(0), a.bytes) < std::make_pair(b.seconds.value_or(0), b.bytes);
    };
    const RunPreview& most = *std::max_element(previews_.begin(), previews_.end(), less);
    print_out("a run: %s\n", rubble::describe(most).c_str());
    print_out("in all: at most %s\n", format_bytes(estimate_ * runs).c_str());
    return ExitCode::done;
  }

  void describe_mission(const Mission& mission, const AssetLibrary& assets,
                        const MissionOptions& options) {
    provenance_ =
        make_provenance(request_.pile_only ? RunKind::settle : RunKind::run, mission, options);
    provenance_.assets = assets.contents;
    provenance_.robots = assets.robots;
    provenance_.snapshot = assets.snapshot;
    provenance_.seed.reset();
  }

  std::string describe() const {
    Json json;
    const BuildInfo build = build_info();
    json["format"] = "rubble batch 1";
    json["program"] = build.version + " " + build.commit;
    json["seeds"] = request_.seeds;
    if (sweep_.varies()) json["vary"] = request_.vary;
    if (request_.samples > 0) json["samples"] = request_.samples;
    add_provenance(json, provenance_);
    return json.dump(2) + "\n";
  }

  std::vector<std::string> arguments_for(const BatchRun& run) const {
    const bool resume = is_begun(run);
    std::vector<std::string> list;
    if (resume) {
      list = {"resume", folder_.of(run.name)};
    } else {
      list = {request_.pile_only ? "settle" : "run",
              request_.of.mission,
              "--seed",
              std::to_string(run.seed),
              "--out",
              folder_.of(run.name)};
      const std::string& device = request_.of.options.device;
      if (!request_.pile_only && !device.empty()) list.insert(list.end(), {"--device", device});
      for (const std::string& text : request_.of.overrides)
        list.insert(list.end(), {"--set", text});
      for (const std::string& text : sweep_.overrides(run.variant))
        list.insert(list.end(), {"--set", text});
    }
    for (const std::string& pack : request_.of.asset_packs)
      list.insert(list.end(), {"--assets", pack});
    list.insert(list.end(), {"--quiet", "--threads", std::to_string(shape_.threads)});
    return list;
  }

  bool is_begun(const BatchRun& run) const {
    std::error_code failed;
    return fs::exists(folder_.of(run.name) + "/unfinished/run.json", failed);
  }

  void make_jobs() {
    for (const BatchRun& run : mine_) {
      if (folder_.state_of(run.name) == RunState::done) {
        ++tally_.done_before;
        continue;
      }
      runs_.push_back(run.name);
      jobs_.push_back({arguments_for(run), folder_.running_log(run.name)});
    }
  }

  void check_disk(std::uint64_t bytes_each, const char* how) const {
    const std::uint64_t needed = bytes_each * (jobs_.size() - tally_.ended);
    const std::uint64_t there = free_bytes(folder_.path());
    if (tally_.ended == 0)
      print_err("batch: %zu runs to do, %zu done before; %s %s each, %s in all; %s free\n",
                jobs_.size(), tally_.done_before, how, format_bytes(bytes_each).c_str(),
                format_bytes(needed).c_str(), format_bytes(there).c_str());
    if (needed <= there || request_.of.force) return;
    throw RunError("the disk is too small for this batch: " + format_bytes(needed) + " needed (" +
                   how + ", " + format_bytes(bytes_each) + " each), " + format_bytes(there) +
                   " free in " + folder_.path() +
                   "; fewer seeds, smaller pictures, another --out, or "
                   "--force to begin all the same");
  }

  // Returns whether to go on.
  bool note(std::size_t i, const JobResult& result) {
    const std::string& run = runs_[i];
    const bool well = result.exit_code == int(ExitCode::done) ||
                      result.exit_code == int(ExitCode::did_not_settle);
    if (result.exit_code == int(ExitCode::stopped)) {
      folder_.file_log(run, false);
      return false;
    }
    // The same batch, begun twice, must not call what the other process does a failure.
    if (!well && (folder_.state_of(run) == RunState::done || folder_.is_at_work(run))) {
      folder_.file_log(run, false);
      ++tally_.elsewhere;
      return true;
    }
    folder_.file_log(run, !well);
    ++tally_.ended;
    tally_.failed += !well;
    tally_.not_settled += result.exit_code == int(ExitCode::did_not_settle);
    if (well) tally_.bytes += count_bytes(folder_.of(run));
    if (!well) failures_.push_back(run);
    progress_.update(double(tally_.ended) / double(jobs_.size()), words());
    return well ? disk_is_enough() : true;
  }

  // Now that some have been measured: stop before the disk is full rather than when it is.
  bool disk_is_enough() {
    const std::size_t measured = tally_.ended - tally_.failed;
    try {
      check_disk(tally_.bytes / measured, "measured");
    } catch (const RunError& error) {
      too_small_ = error.what();
    }
    return too_small_.empty();
  }

  std::string words() const {
    const std::string others =
        tally_.elsewhere == 0
            ? ""
            : ", " + std::to_string(tally_.elsewhere) + " in the hands of another process";
    return std::to_string(tally_.ended + tally_.done_before) + " of " +
           std::to_string(mine_.size()) + (sweep_.varies() ? " runs, " : " seeds, ") + std::to_string(tally_.failed) + " failed" +
           others;
  }

  void write_index() {
    const FolderLock lock(folder_.path() + "/batch.lock", FolderLock::Wait::yes);
    const BatchIndex index = make_batch_index(folder_.path(), sweep_, all_);
    altered_ = index.altered;
    write_text_file(folder_.path() + "/index.csv", index.text);
  }

  ExitCode report() {
    std::sort(failures_.begin(), failures_.end());
    for (const std::string& run : failures_) {
      const std::string log = folder_.failure_log(run);
      print_err("%s failed (%s):\n%s\n", words_for(run).c_str(), log.c_str(),
                tail_of_log(log, 3).c_str());
    }
    if (stop_requested())
      throw Stopped("stopped by a signal, with " + words() + "; the same command continues");
    if (!too_small_.empty()) throw RunError(too_small_);
    print_out("%s/index.csv\n", folder_.path().c_str());
    for (const std::string& sentence : altered_)
      print_err("%s\nremove its folder and run the batch again\n", sentence.c_str());
    if (tally_.failed > 0 || !altered_.empty()) return ExitCode::failure;
    return tally_.not_settled > 0 ? ExitCode::did_not_settle : ExitCode::done;
  }

  // "seed 7"; of a variant the name of its folder.
  std::string words_for(const std::string& run) const {
    return sweep_.varies() ? run : "seed " + run.substr(run.find('_') + 1);
  }

  const BatchRequest& request_;
  std::vector<std::uint64_t> all_;  // seeds of the whole batch
  Sweep sweep_;
  std::vector<BatchRun> mine_;      // of this shard
  JobShape shape_;
  BatchFolder folder_;
  Progress progress_;
  Provenance provenance_;
  std::uint64_t estimate_ = 0;
  std::vector<RunPreview> previews_;  // of the values that were looked at
  std::vector<std::string> runs_;  // names, one per job
  std::vector<Job> jobs_;
  std::vector<std::string> failures_;
  std::string too_small_;
  std::vector<std::string> altered_;  // sentences, see BatchIndex
  Tally tally_;
};

}  // namespace

ExitCode run_batch(const BatchRequest& request) {
  stop_on_signals();
  return Batch(request).run();
}

}  // namespace rubble
