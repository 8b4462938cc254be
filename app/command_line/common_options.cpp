#include "app/command_line/common_options.h"

#include <charconv>
#include <cstdint>
#include <cstdio>

#include "app/support/drawing_device.h"

namespace rubble {

void add_mission_options(CommandLine& line, RunRequest& request, const std::string& name) {
  line.add(name, request.mission, "The mission: a Lua script").required().metavar("FILE");
  line.add("--set", request.overrides, "Set a key of the mission, as in pile.layers=3")
      .metavar("KEY=VALUE");
  add_packs_option(line, request.asset_packs, "Additional asset pack: a folder with a pack.lua");
}

void add_seed_option(CommandLine& line, RunRequest& request) {
  const auto read = [&request](const std::string& text) -> std::string {
    std::int64_t seed = -1;  // as a script's
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, seed);
    if (result.ec != std::errc() || result.ptr != end || seed < 0)
      return "expected a whole number from 0 to 9223372036854775807, found " + text;
    request.seed = std::uint64_t(seed);
    return "";
  };
  line.add_read("--seed", read, "Seed of all random numbers; replaces that of the script").metavar("N");
}

void add_track_option(CommandLine& line, RunRequest& request) {
  line.add_flag("--track", request.track,
                "Record the motion of the settling pile as track.bin and as the glTF animation track.glb");
}

void add_threads_option(CommandLine& line, int& threads) {
  line.add("--threads", threads,
           "Number of threads; 0: one per processor. The results do not depend on it")
      .between(0, 256);
}

void add_device_option(CommandLine& line, std::string& device) {
  const auto read = [&device](const std::string& text) -> std::string {
    if (!read_device(text)) return "expected " + describe_devices() + ", found " + text;
    device = text;
    return "";
  };
  line.add_read("--device", read,
                "What draws: `software`, this program on the processor, without any driver, or `gl`, a graphics card. "
                "`gl:N` is the card with the number N in `rubble info --gl`")
      .shows_default_text("$RUBBLE_DEVICE, else the key `device` of the mission; of a finished run, the device of its manifest")
      .metavar("DEVICE");
}

void add_size_option(CommandLine& line, int& width, int& height) {
  // "480x360", both within what a camera may have.
  const auto read = [&width, &height](const std::string& text) -> std::string {
    int w = 0, h = 0, end = 0;
    const int found = std::sscanf(text.c_str(), "%dx%d%n", &w, &h, &end);
    const bool whole = found == 2 && std::size_t(end) == text.size();
    if (!whole || w < 16 || h < 16 || w > 8192 || h > 8192)
      return "expected WIDTHxHEIGHT from 16x16 to 8192x8192, found " + text;
    width = w, height = h;
    return "";
  };
  line.add_read("--size", read, "Size of the colour image")
      .shows_default_text(std::to_string(width) + "x" + std::to_string(height))
      .metavar("WxH");
}

void add_quiet_option(CommandLine& line, bool& quiet) {
  line.add_flag("--quiet", quiet, "Print errors only, no progress");
}

void add_packs_option(CommandLine& line, std::vector<std::string>& folders,
                      const std::string& help) {
  line.add("--assets", folders, help).metavar("DIR");
}

void add_run_options(CommandLine& line, RunOptions& options) {
  add_device_option(line, options.device);
  add_threads_option(line, options.threads);
  add_quiet_option(line, options.quiet);
}

void add_checkpoint_option(CommandLine& line, RunOptions& options) {
  line.add("--checkpoint-every", options.checkpoint_every,
           "Interval of checkpoints while settling")
      .shows_default("s")
      .metavar("SECONDS")
      .within(0.0, 1e6);
}

void add_output_options(CommandLine& line, RunRequest& request) {
  line.add("--out", request.out, "Output folder")
      .shows_default_text("out/<name of the script>")
      .metavar("DIR");
  line.add_flag("--force", request.force, "Replace the files of an earlier run");
}

void add_preview_option(CommandLine& line, RunRequest& request) {
  line.add_flag("--preview", request.preview,
                "Print the numbers of pieces and frames, the disk space and the approximate time. Run nothing");
}

void add_folder_options(CommandLine& line, FolderRequest& request) {
  line.add("folder", request.folder, "The output folder of a run").required().metavar("DIR");
  add_packs_option(line, request.asset_packs, "Folder of an asset pack of the run, if it was moved");
}

void add_jobs_options(CommandLine& line, int& jobs, RunOptions& options) {
  line.add("--jobs", jobs, "Number of simultaneous runs").shows_default_text("one per processor").between(0, 1024);
  line.add("--threads", options.threads, "Threads of each run")
      .shows_default_text("the number of processors, divided by --jobs")
      .between(0, 256);
  add_device_option(line, options.device);
  add_quiet_option(line, options.quiet);
}

void add_space_options(CommandLine& line, SpaceRequest& request) {
  line.add("--radius", request.radii, "Radius of a robot; may be repeated").shows_default().metavar("METRES").within(0.001, 10.0);
  line.add("--voxel", request.voxel, "Edge of a voxel").shows_default().metavar("METRES").within(0.001, 1.0);
  line.add("--outside-radius", request.outside_radius,
           "Radius of the ball that defines the outside: the space that the ball reaches from the sky")
      .shows_default()
      .metavar("METRES")
      .within(0.2, 10.0);
  line.add("--memory", request.memory_gib, "Largest memory. The command refuses to start if it needs more")
      .shows_default()
      .metavar("GIB")
      .positive();
}

void add_score_options(CommandLine& line, ScoreOutput& output) {
  line.add_flag("--json", output.json, "Print the result as JSON");
  line.add("--out", output.files, "Write the table to a file: .csv, .json or .tex (LaTeX)").metavar("FILE");
}

}  // namespace rubble
