#include "app/commands/arguments.h"

#include <charconv>
#include <cstdint>

namespace rubble {

CLI::Option* add_list(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                      const std::string& text, const std::string& type) {
  return command.add_option(name, values, text)
      ->type_name(type)
      ->allow_extra_args(false)
      ->take_all();
}

void add_mission_options(CLI::App& command, RunRequest& request, const std::string& name) {
  command.add_option(name, request.mission, "The mission, a Lua script")->required();
  add_list(command, "--set", request.overrides, "Override a key of the mission: key=value",
           "KEY=VALUE");
  add_list(command, "--assets", request.asset_packs, "A further folder with a pack.lua", "DIR");
}

void add_seed_option(CLI::App& command, RunRequest& request) {
  command
      .add_option_function<std::string>(
          "--seed",
          [&request](const std::string& text) {
            std::int64_t seed = -1;  // as a script's
            const char* const end = text.data() + text.size();
            const auto read = std::from_chars(text.data(), end, seed);
            if (read.ec != std::errc() || read.ptr != end || seed < 0)
              throw CLI::ValidationError(
                  "--seed", "expected a whole number from 0 to 9223372036854775807, found " + text);
            request.seed = std::uint64_t(seed);
          },
          "Seed of all randomness; overrides the script's")
      ->type_name("UINT");
}

void add_threads_option(CLI::App& command, int& threads, const std::string& text) {
  command.add_option("--threads", threads, text)->check(CLI::Range(0, 256));
}

void add_device_option(CLI::App& command, int& device) {
  command
      .add_option(
          "--gl-device", device,
          "Number of the EGL device that draws (default: $RUBBLE_EGL_DEVICE, or the first that "
          "works, hardware before software)")
      ->type_name("N")
      ->check(CLI::Range(0, 1000));
}

void add_run_options(CLI::App& command, RunOptions& options) {
  add_device_option(command, options.gl_device);
  add_threads_option(command, options.threads,
                     "Threads to use; 0: all processors. Results do not depend on it");
  command.add_flag("--quiet", options.quiet, "No progress, only errors");
  command
      .add_option("--checkpoint-every", options.checkpoint_every,
                  "Keep a checkpoint of settling that often (default: 10 s)")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e6));
}

void add_output_options(CLI::App& command, RunRequest& request) {
  command.add_option("--out", request.out, "Output folder (default: out/<name of the script>)")
      ->type_name("DIR");
  command.add_flag("--force", request.force, "Replace the files of an earlier run");
  add_run_options(command, request.options);
}

void add_folder_options(CLI::App& command, FolderRequest& request) {
  command.add_option("folder", request.folder, "The output folder of a run")->required();
  add_list(command, "--assets", request.asset_packs, "A folder where packs of the run may be now",
           "DIR");
  add_run_options(command, request.options);
}

void add_jobs_options(CLI::App& command, int& jobs, RunOptions& options) {
  command.add_option("--jobs", jobs, "Runs at once (default: one a processor)")
      ->check(CLI::Range(0, 1024));
  add_threads_option(command, options.threads,
                     "Threads of each run (default: the processors, divided by --jobs)");
  command.add_flag("--quiet", options.quiet, "No progress, only errors");
}

}  // namespace rubble
