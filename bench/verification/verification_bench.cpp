// verification_bench: do figures of piles, ruins and robots depend on the step and the number of sweeps?
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "app/batch/seed_list.h"
#include "app/support/job_pool.h"
#include "app/support/stop.h"
#include "bench/equilibrium/record_file.h"
#include "bench/program.h"
#include "bench/verification/variants.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::vector<std::string> works;
  std::string seeds = "1..20";
  std::string out;
  int jobs = 1;
  bool one = false;  // this process is a job: print one record
  Variant variant{0, 0};
};

struct Item {
  std::string work;
  std::uint64_t seed = 0;
  Variant variant;
};

Job make_job(const Item& item, const fs::path& folder) {
  Job job;
  job.arguments = {"--one", "--work", item.work, "--seeds", std::to_string(item.seed), "--hz",
                   std::to_string(item.variant.step_hz), "--substeps", std::to_string(item.variant.substeps)};
  job.log = folder / (name_of(item.work, item.variant) + "-" + std::to_string(item.seed));
  return job;
}

// The last line of a job's log is its record.
bool take_record(const Job& job, const JobResult& result, RecordFile& file) {
  const Record record = Record::parse(tail_of_log(job.log, 1), nullptr, false);
  if (!record.is_object()) {
    std::fprintf(stderr, "%s: exit code %d\n%s\n", fs::path(job.log).filename().c_str(), result.exit_code,
                 tail_of_log(job.log, 20).c_str());
    return false;
  }
  file.add(record);
  std::fprintf(stderr, "%s, seed %s: %.1f s\n", record["work"].get<std::string>().c_str(), record["seed"].dump().c_str(), result.seconds);
  return true;
}

// Seed by seed, so that a run that is stopped has whole seeds.
ExitCode run_list(const Request& request) {
  stop_on_signals();
  RecordFile file(request.out);
  const fs::path folder = fs::temp_directory_path() / ("verification." + std::to_string(getpid()));
  fs::create_directories(folder);
  std::vector<Job> jobs;
  for (const std::uint64_t seed : parse_seeds(request.seeds, "--seeds"))
    for (const std::string& work : request.works)
      for (const Variant& variant : variants_of(work))
        if (!file.find(name_of(work, variant), seed)) jobs.push_back(make_job({work, seed, variant}, folder));
  std::size_t done = 0;
  run_jobs(jobs, request.jobs, [&](std::size_t i, const JobResult& result) {
    if (!stop_requested()) done += take_record(jobs[i], result, file);
    return true;
  });
  fs::remove_all(folder);
  if (done == jobs.size()) return ExitCode::done;
  return stop_requested() ? ExitCode::stopped : ExitCode::failure;
}

ExitCode print_one(Request request) {
  const std::string& work = request.works.front();
  const Variant usual = variants_of(work).front();
  if (request.variant.step_hz == 0) request.variant.step_hz = usual.step_hz;
  if (request.variant.substeps == 0) request.variant.substeps = usual.substeps;
  std::printf("%s\n", measure(work, parse_seeds(request.seeds, "--seeds").front(), request.variant, 1).dump().c_str());
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Settles the same piles and ruins, and drives the same robots, at other steps and with other numbers of sweeps; "
               "bench/verification/page.py makes tables of the records."};
  app.footer("Works:\n" + describe_verified_works() + "Exit codes: 0 done, 1 bad input, 2 failure, 4 stopped.");
  Request request;
  request.works = verified_works();
  app.add_option("--work", request.works, "Names of works")->delimiter(',')->default_str("all");
  app.add_option("--seeds", request.seeds, "As in 1..20 or 3,5,9")->capture_default_str();
  app.add_option("--jobs", request.jobs, "At once, each in a process and on a thread of its own")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--out", request.out, "File of records; what it holds already is not run again");
  app.add_flag("--one", request.one, "Print the record of the first work and seed as JSON, with --hz and --substeps");
  app.add_option("--hz", request.variant.step_hz, "Steps a second")->check(CLI::Range(30, 1000));
  app.add_option("--substeps", request.variant.substeps, "Sweeps in a step")->check(CLI::Range(1, 64));
  return parse_and_run(app, argc, argv, [&] { return request.one ? print_one(request) : run_list(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("verification_bench", [=] { return rubble::run(argc, argv); });
}
