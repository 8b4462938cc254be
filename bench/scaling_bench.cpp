// scaling_bench: how the time per piece grows with the number of pieces.
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/calibration.h"
#include "bench/program.h"
#include "bench/settle_run.h"
#include "bench/standard_mix.h"
#include "bench/workload_file.h"
#include "kernel/settling/generator.h"

namespace rubble {
namespace {

struct Request {
  std::vector<int> pieces{300, 1000, 3000, 10000, 20000};
  int threads = 1;
  std::uint64_t seed = 1;
};

std::string standard_work() {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "w0.txt").string();
}

void print(const SettleRun& run) {
  const double pieces = double(run.state.pieces.size());
  const double steps = double(std::max<std::int64_t>(run.state.steps, 1));
  std::printf("%d,%d,%.3f,%.3f,%.4f,%lld,%d,%.4f,%.4f,%.1f,%s\n", int(run.state.pieces.size()),
              run.threads, run.wall, run.cpu, run.state.simulated, (long long)run.state.steps,
              int(run.state.settled), 1e3 * run.cpu / pieces, 1e6 * run.cpu / pieces / steps,
              run.peak_rss, calibration_csv(calibrate()).c_str());
  std::fflush(stdout);
}

// In a process of its own: what a pile before it gave back stays with the process in part, and would count as memory of
// this one.
ExitCode settle_alone(const Pile& work, int pieces, const Request& request) {
  const pid_t child = fork();
  if (child < 0) throw RunError(std::string("scaling_bench: cannot start a process: ") + std::strerror(errno));
  if (child == 0) {
    const int code = run_program("scaling_bench", [&] {
      SettleJob job;
      job.work = std::to_string(pieces);
      job.options.threads = request.threads;
      job.judge = false;
      print(run_settling(generate_pile(make_standard_mix(work, pieces, request.seed)), job));
      return ExitCode::done;
    });
    _exit(code);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) return ExitCode(WEXITSTATUS(status));
  std::fprintf(stderr, "scaling_bench: %d pieces: stopped by signal %d\n", pieces, WTERMSIG(status));
  return ExitCode::failure;
}

ExitCode bench(const Request& request) {
  const Pile work = load_workload(standard_work());
  std::printf(
      "pieces,threads,wall_s,cpu_s,sim_s,steps,settled,cpu_ms_per_piece,"
      "cpu_us_per_piece_and_step,peak_rss_mib,%s\n",
      calibration_csv_header().c_str());
  std::fflush(stdout);
  ExitCode code = ExitCode::done;
  for (std::size_t i = 0; i < request.pieces.size() && code == ExitCode::done; ++i)
    code = settle_alone(work, request.pieces[i], request);
  return code;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Settles piles of growing size, of the same density and height, schedule layers, "
      "and prints the CPU time per piece as comma-separated lines."};
  app.footer("Exit codes: 0 done, 1 bad input, 2 failure.");
  Request request;
  app.add_option("--pieces", request.pieces, "Sizes, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(4, 1000000))
      ->capture_default_str();
  app.add_option("--threads", request.threads, "Threads of the kernel; 0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--seed", request.seed, "Seed of the piles")->capture_default_str();
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("scaling_bench", [=] { return rubble::run(argc, argv); });
}
