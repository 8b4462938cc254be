// equilibrium_bench: do the piles of the work list come to rest, and is their rest an equilibrium?
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "app/batch/seed_list.h"
#include "app/support/job_pool.h"
#include "app/support/stop.h"
#include "bench/equilibrium/contact_finder.h"
#include "bench/equilibrium/pile_record.h"
#include "bench/equilibrium/record_file.h"
#include "bench/equilibrium/work.h"
#include "bench/program.h"
#include "bench/settle_run.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::vector<std::string> works{"packs"};
  std::vector<std::string> overrides;
  std::string seeds = "1..3";
  std::string out;
  std::string saved;  // the folder of a finished run: judge its pile, settle nothing
  Schedule schedule = Schedule::layers;
  int threads = 1;
  int jobs = 1;
  bool one = false;  // this process is a job: print one record
  bool by_layer = false;
  bool pile_only = false;
  bool no_balance = false;
  double tolerance = kContactTolerance;
  bool markdown = false;
};

struct Item {
  std::string work;
  std::uint64_t seed = 0;
};

SettleJob make_settle_job(const Item& item, const Work& work, const Request& request) {
  SettleJob job;
  job.work = item.work;
  job.options = work.settle;
  job.options.schedule = request.schedule;
  job.options.threads = request.threads;
  job.drift = !request.pile_only;
  return job;
}

// What each layer of the pile costs; nobody judges it.
ExitCode print_layers(const Item& item, const Request& request) {
  const Work work = load_work(item.work, item.seed, request.overrides);
  SettleJob job = make_settle_job(item, work, request);
  job.judge = false;
  const SettleRun run = run_settling(work.pile, job);
  std::fputs(layer_csv(run.layers).c_str(), stdout);
  return run.state.settled ? ExitCode::done : ExitCode::did_not_settle;
}

// The linear program knows no bars that hold and no bodies of several pieces.
bool has_balance(const PileState& state) { return state.building.count == 0; }

Record run_one(const Item& item, const Request& request) {
  const Work work = load_work(item.work, item.seed, request.overrides);
  const SettleJob job = make_settle_job(item, work, request);
  const SettleRun run = run_settling(work.pile, job);
  Record record = make_record(work, run);
  add_surface_depth(work.pile, run.state, record);
  if (!request.pile_only && !request.no_balance && has_balance(run.state))
    add_balance(work, run.state, request.tolerance, record);
  return record;
}

// What can be said of a pile that lies on the disk: all but times, ejection and drift.
Record judge_saved(const Request& request) {
  const SavedPile saved = load_saved_pile(request.saved);
  SettleRun run;
  run.work = saved.work.name;
  run.state = saved.state;
  run.overlaps = check_overlaps(saved.work.pile.types, saved.state);
  Record record = make_record(saved.work, run);
  for (const char* unknown : {"schedule", "cpu_s", "wall_s", "ejected", "drift_median_mm",
                              "drift_p99_mm", "drift_max_mm", "drift_over_20mm"})
    record.erase(unknown);
  add_surface_depth(saved.work.pile, saved.state, record);
  if (!request.no_balance && has_balance(saved.state)) add_balance(saved.work, saved.state, request.tolerance, record);
  return record;
}

Job make_job(const Item& item, const Request& request, const fs::path& folder) {
  Job job;
  job.arguments = {"--one", "--work", item.work, "--seeds", std::to_string(item.seed),
                   "--threads", std::to_string(request.threads), "--schedule",
                   request.schedule == Schedule::layers ? "layers" : "planes"};
  for (const std::string& change : request.overrides) {
    job.arguments.push_back("--set");
    job.arguments.push_back(change);
  }
  if (request.pile_only) job.arguments.push_back("--pile-only");
  if (request.no_balance) job.arguments.push_back("--no-lp");
  job.arguments.push_back("--tolerance");
  job.arguments.push_back(exact_text(request.tolerance));
  job.log = folder / (fs::path(item.work).stem().string() + "-" + std::to_string(item.seed));
  return job;
}

// The last line of a job's log is its record.
void take_record(const Item& item, const Job& job, const JobResult& result, RecordFile& file) {
  const std::string text = tail_of_log(job.log, 1);
  const Record record = Record::parse(text, nullptr, false);
  if (record.is_discarded() || !record.is_object()) {
    std::fprintf(stderr, "%s, seed %llu: exit code %d\n%s\n", item.work.c_str(),
                 (unsigned long long)item.seed, result.exit_code,
                 tail_of_log(job.log, 20).c_str());
    return;
  }
  file.add(record);
  std::fprintf(stderr, "%s\n", describe_record(record).c_str());
}

ExitCode run_list(const std::vector<Item>& items, const Request& request) {
  stop_on_signals();
  RecordFile file(request.out);
  const fs::path folder =
      fs::temp_directory_path() / ("equilibrium." + std::to_string(getpid()));
  fs::create_directories(folder);
  std::vector<Item> open;
  std::vector<Job> jobs;
  for (const Item& item : items) {
    if (file.find(item.work, item.seed)) continue;
    open.push_back(item);
    jobs.push_back(make_job(item, request, folder));
  }
  run_jobs(jobs, request.jobs, [&](std::size_t i, const JobResult& result) {
    if (!stop_requested()) take_record(open[i], jobs[i], result, file);
    return true;
  });
  fs::remove_all(folder);
  std::vector<Record> records;
  bool settled = true;
  for (const Item& item : items) {
    const Record* record = file.find(item.work, item.seed);
    if (record) records.push_back(*record);
    settled = settled && record && record->at("settled").get<bool>();
  }
  if (!records.empty())
    std::printf("%s\n%s", make_pile_table(records, request.markdown).c_str(),
                make_work_table(records, request.markdown).c_str());
  if (records.size() < items.size())
    return stop_requested() ? ExitCode::stopped : ExitCode::failure;
  return settled ? ExitCode::done : ExitCode::did_not_settle;
}

ExitCode print(const Record& record) {
  std::printf("%s\n", record.dump().c_str());
  return record.at("settled").get<bool>() ? ExitCode::done : ExitCode::did_not_settle;
}

ExitCode bench(const Request& request) {
  if (!request.saved.empty()) return print(judge_saved(request));
  std::vector<Item> items;
  for (const std::string& work : expand_work_names(request.works))
    for (const std::uint64_t seed : parse_seeds(request.seeds, "--seeds"))
      items.push_back({work, seed});
  if (request.by_layer) return print_layers(items.front(), request);
  if (!request.one) return run_list(items, request);
  return print(run_one(items.front(), request));
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Settles the piles of a work list and judges them apart from the kernel."};
  app.footer("Works:\n" + describe_work_names() +
             "Exit codes: 0 all rest, 1 bad input, 2 failure, 3 not all rest, 4 stopped.");
  Request request;
  const std::map<std::string, Schedule> schedules{{"layers", Schedule::layers},
                                                  {"planes", Schedule::planes}};
  app.add_option("--work", request.works, "Names of works or groups, missions or workload files")
      ->delimiter(',')
      ->default_str("packs");
  app.add_option("--seeds", request.seeds, "As in 1..20 or 3,5,9; 0: a workload file as written")
      ->capture_default_str();
  app.add_option("--set", request.overrides, "key=value, of missions")
      ->allow_extra_args(false)
      ->take_all();
  app.add_option("--schedule", request.schedule, "How layers follow each other: layers or planes")
      ->transform(CLI::CheckedTransformer(schedules))
      ->default_str("layers");
  app.add_option("--jobs", request.jobs, "Piles at once, each in a process of its own")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--threads", request.threads, "Threads of the kernel for each; 0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--out", request.out, "File of records; what it holds already is not run again");
  app.add_option("--pile", request.saved,
                 "Judge the settled pile of this finished run, and print its record");
  app.add_flag("--pile-only", request.pile_only, "Rest, overlaps and time: no drift, no balance");
  app.add_flag("--no-lp", request.no_balance, "No balance: the linear program is left out, as it is for buildings");
  app.add_option("--tolerance", request.tolerance, "Surfaces nearer than this touch; unit: m")
      ->check(CLI::Range(1e-5, 0.05))
      ->capture_default_str();
  app.add_flag("--markdown", request.markdown, "Tables for a document");
  app.add_flag("--by-layer", request.by_layer,
               "Instead print what each layer of the first pile costs: steps, pieces awake, times of the stages, as "
               "comma-separated lines");
  app.add_flag("--one", request.one, "Print the record of the first pile as JSON");
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("equilibrium_bench", [=] { return rubble::run(argc, argv); });
}
