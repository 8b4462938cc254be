// settle_bench: the standard work, timed and judged.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/busy_run.h"
#include "bench/calibration.h"
#include "bench/free_run.h"
#include "bench/hold_run.h"
#include "bench/program.h"
#include "bench/report.h"
#include "bench/settle_run.h"
#include "bench/sweep_run.h"
#include "bench/workload_file.h"
#include "kernel/base/system/thread_count.h"

namespace rubble {
namespace {

struct Request {
  std::string work = "w1";
  Schedule schedule = Schedule::layers;
  int threads = 1;
  int repeat = 1;
  int worst = 0;
  std::uint64_t seed = 0;
  bool csv = false;
  bool hold = false;
  bool sweeps = false;
  std::vector<int> busy;
  int steps = 0;  // 0: settle
  bool no_sleep = false;
};

// A path as it is; a bare name like "w1" stands for the file that the build wrote.
std::string find_work(const std::string& work) {
  namespace fs = std::filesystem;
  if (fs::exists(work)) return work;
  const fs::path beside = fs::read_symlink("/proc/self/exe").parent_path() / (work + ".txt");
  return work.find_first_of("./") == std::string::npos ? beside.string() : work;
}

// A line of figures, or text for people; beside either how fast the machine is just now.
void print(const std::string& header, const std::string& line, const std::string& text,
           const Request& request, bool first) {
  const Calibration machine = calibrate();
  if (request.csv) {
    if (first) std::printf("%s,%s\n", header.c_str(), calibration_csv_header().c_str());
    std::printf("%s,%s\n", line.c_str(), calibration_csv(machine).c_str());
  } else {
    std::printf("%s  %s", text.c_str(), calibration_text(machine).c_str());
  }
  std::fflush(stdout);
}

void print(const SettleRun& run, const Request& request, bool first) {
  print(csv_header(), csv_line(run), table_text(run), request, first);
  // Beside the figures, never among the lines of --csv.
  if (request.worst > 0) std::fputs(worst_text(run, request.worst).c_str(), stderr);
}

// On one thread and on two, whatever the pile was settled on.
ExitCode hold(const Pile& pile, const SettleJob& job, const Request& request) {
  bool settled = true;
  for (int i = 0; i < request.repeat; ++i) {
    for (const HoldRun& run : run_hold(pile, job, {1, 2})) {
      print(hold_csv_header(), hold_csv_line(run), hold_text(run), request,
            i == 0 && run.threads == 1);
      settled = settled && run.settled;
    }
  }
  return settled ? ExitCode::done : ExitCode::did_not_settle;
}

ExitCode run_steps(const Pile& pile, const SettleJob& job, const Request& request) {
  const std::vector<int> threads(std::size_t(request.repeat), request.threads > 0 ? request.threads : default_thread_count());
  bool first = true;
  for (const FreeRun& run : run_free(pile, job, request.steps, !request.no_sleep, threads)) {
    print(free_csv_header(), free_csv_line(run), free_text(run), request, first);
    first = false;
  }
  return ExitCode::done;
}

// What more threads than there are would gain.
ExitCode plan_sweeps(const Pile& pile, const SettleJob& job) {
  const SweepRun run = run_sweeps(pile, job, {1, 2, 4, 8, 16});
  std::fputs(sweep_csv(run).c_str(), stdout);
  return run.settled ? ExitCode::done : ExitCode::did_not_settle;
}

// What more threads cost where others use the machine, too.
ExitCode run_beside_loops(const Pile& pile, const SettleJob& job, const Request& request) {
  const std::vector<BusyRun> runs = run_busy(pile, job, request.busy, {1, std::max(2, request.threads)}, request.repeat);
  std::fputs(busy_csv(job, runs).c_str(), stdout);
  return ExitCode::done;
}

ExitCode bench(const Request& request) {
  const std::string path = find_work(request.work);
  Pile pile = load_workload(path);
  if (request.seed != 0) turn_pieces(pile, request.seed);
  SettleJob job;
  job.work = std::filesystem::path(path).stem().string();
  if (request.seed != 0) job.work += "+" + std::to_string(request.seed);
  job.options.schedule = request.schedule;
  job.options.threads = request.threads;
  if (request.steps > 0) return run_steps(pile, job, request);
  if (request.hold) return hold(pile, job, request);
  if (request.sweeps) return plan_sweeps(pile, job);
  if (!request.busy.empty()) return run_beside_loops(pile, job, request);
  bool settled = true;
  std::uint64_t hash = 0;
  for (int i = 0; i < request.repeat; ++i) {
    const SettleRun run = run_settling(pile, job);
    print(run, request, i == 0);
    settled = settled && run.state.settled;
    if (i > 0 && run.state.state_hash() != hash) {
      throw RunError("a repetition ended in another state: the same work must give the same bits");
    }
    hash = run.state.state_hash();
  }
  return settled ? ExitCode::done : ExitCode::did_not_settle;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Settles a standard pile, and lets an independent judge measure the result."};
  app.footer("Exit codes: 0 done, 1 bad input, 2 failure, 3 finished but did not settle.");
  Request request;
  const std::map<std::string, Schedule> schedules{{"layers", Schedule::layers},
                                                  {"planes", Schedule::planes}};
  app.add_option("--work", request.work, "A workload file, or w0, w1, w2, pyramid, convex_vs_mesh or convex_pile")->capture_default_str();
  app.add_option("--schedule", request.schedule, "How layers follow each other: layers or planes")
      ->transform(CLI::CheckedTransformer(schedules))
      ->default_str("layers");
  app.add_option("--threads", request.threads, "Threads of the kernel; 0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--repeat", request.repeat, "Run so often; the states must be equal")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", request.seed, "Draw all orientations anew; 0: those of the file")
      ->capture_default_str();
  app.add_option("--worst", request.worst, "Also name so many of the worst pieces, on stderr")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_flag("--hold", request.hold,
               "Instead measure steps of the settled pile with sleep off, on one thread and two");
  app.add_flag("--sweeps", request.sweeps,
               "Instead plan the sweeps of the settled pile with sleep off, for up to 16 threads: work, longest chain, "
               "waiting, as comma-separated lines");
  app.add_option("--busy", request.busy,
                 "Instead settle beside so many busy loops, in turn on one thread and on --threads (two at least), "
                 "--repeat times each: median times and their ratio, as comma-separated lines")
      ->check(CLI::Range(0, 1024));
  CLI::Option* steps =
      app.add_option("--steps", request.steps,
                     "Instead make so many steps with all pieces from the start, heights as in the file; as other engines' benches")
          ->check(CLI::Range(1, 1000000));
  app.add_flag("--no-sleep", request.no_sleep, "With --steps: nothing falls asleep")->needs(steps);
  app.add_flag("--csv", request.csv, "Lines of comma-separated figures below a line of names");
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("settle_bench", [=] { return rubble::run(argc, argv); });
}
