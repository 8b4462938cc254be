// The command line: a table of commands; parses, calls one, turns errors into messages and exit
// codes.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/commands/arguments.h"
#include "app/commands/commands.h"
#include "app/support/build_info.h"
#include "kernel/base/text.h"
#include "scripting/reference/schema_docs.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

using Commands = std::vector<std::pair<CLI::App*, Action>>;

void add_void_options(CLI::App& command, VoidRequest& request) {
  add_space_options(command, request, "0.02");
  command
      .add_option("--surfaces", request.surfaces,
                  "Write the surfaces of so many voids of each radius, largest first (default: 20)")
      ->check(CLI::Range(0, 100000));
  command.add_option("--out", request.out, "Output folder (default: FOLDER/voids)")
      ->type_name("DIR");
  command.add_flag("--force", request.force, "Replace the files of an earlier map");
}

Action add_run(CLI::App& command) {
  const auto request = std::make_shared<RunRequest>();
  add_mission_options(command, *request);
  add_seed_option(command, *request);
  add_output_options(command, *request);
  add_live_options(command, request->options.live);
  return [request] { return run_mission(*request); };
}

Action add_settle(CLI::App& command) {
  const auto request = std::make_shared<RunRequest>();
  add_mission_options(command, *request);
  add_seed_option(command, *request);
  add_output_options(command, *request);
  return [request] { return settle_mission(*request); };
}

// "480x360", both within what a camera may have.
std::string read_size(const std::string& text, DriveRequest& request) {
  int width = 0, height = 0, end = 0;
  const int read = std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &end);
  const bool whole = read == 2 && std::size_t(end) == text.size();
  if (!whole || width < 16 || height < 16 || width > 8192 || height > 8192)
    return "expected WIDTHxHEIGHT from 16x16 to 8192x8192, found " + text;
  request.width = width;
  request.height = height;
  return "";
}

Action add_drive(CLI::App& command) {
  const auto request = std::make_shared<DriveRequest>();
  add_mission_options(command, request->of);
  add_seed_option(command, request->of);
  command
      .add_option_function<std::string>(
          "--size",
          [request](const std::string& text) {
            const std::string mistake = read_size(text, *request);
            if (!mistake.empty()) throw CLI::ValidationError("--size", mistake);
          },
          "Size of the colour image (default: 480x360)")
      ->type_name("WxH");
  command.add_option("--steps", request->steps, "End after so many steps (default: none)")
      ->check(CLI::Range(0, 1000000000));
  command.add_flag("--record", request->record, "Write the mission's recordings while driving");
  add_ros_options(command, request->of.options.live,
                  "Publish to ROS 1 what is seen, and let /cmd_vel and /joy drive, too");
  command.get_option("--ros1")->excludes("--ros2");  // one that is heard
  command.add_option("--out", request->of.out, "Output folder (default: out/<script>_drive)")
      ->type_name("DIR");
  command.add_flag("--force", request->of.force, "Replace the legs of an earlier drive");
  add_device_option(command, request->of.options.gl_device);
  add_threads_option(command, request->of.options.threads,
                     "Threads to use; 0: all processors. Results do not depend on it");
  command.add_flag("--quiet", request->of.options.quiet, "No progress, only errors");
  return [request] { return drive_mission(*request); };
}

Action add_resume(CLI::App& command) {
  const auto request = std::make_shared<FolderRequest>();
  add_folder_options(command, *request);
  return [request] { return resume_run(*request); };
}

Action add_verify(CLI::App& command) {
  const auto request = std::make_shared<VerifyRequest>();
  add_folder_options(command, request->of);
  command.add_option("--work", request->work, "Where to make the run anew (default: $TMPDIR)")
      ->type_name("DIR");
  command.add_flag("--pile-only", request->pile_only, "Settle again, but render nothing");
  command.add_flag("--json", request->json, "The result as JSON");
  return [request] { return verify_run(*request); };
}

Action add_render(CLI::App& command) {
  const auto request = std::make_shared<RunRequest>();
  const auto from = std::make_shared<std::string>();
  command.add_option("folder", *from, "The output folder of the run with the pile")->required();
  add_mission_options(command, *request, "--mission");
  add_seed_option(command, *request);
  add_output_options(command, *request);
  add_live_options(command, request->options.live);
  return [request, from] { return render_saved_pile(*from, *request); };
}

Action add_voids(CLI::App& command) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<VoidRequest>();
  add_folder_options(command, *of);
  add_void_options(command, *request);
  return [of, request] { return map_voids(*of, *request); };
}

Action add_export(CLI::App& command) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<ExportRequest>();
  add_folder_options(command, *of);
  command.add_option("--format", request->formats, "stl, ply, obj, glb or sdf (default: all)")
      ->type_name("FORMAT")
      ->delimiter(',');
  command.add_option("--out", request->out, "Output folder (default: FOLDER/export)")
      ->type_name("DIR");
  command.add_flag("--force", request->force, "Replace the files of an earlier export");
  return [of, request] { return export_saved_pile(*of, *request); };
}

Action add_cutaway(CLI::App& command) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<CutawayRequest>();
  add_folder_options(command, *of);
  command.add_option("--y", request->y, "Where the plane is that cuts across Y (default: 0)")
      ->type_name("METRES")
      ->check(CLI::Range(-1000.0, 1000.0));
  command.add_option("--width", request->width, "Of the picture, in pixels (default: 900)")
      ->check(CLI::Range(200, 4000));
  command.add_option("--title", request->title, "Printed above the picture");
  command
      .add_option("--out", request->out, "The picture, .png or .jpg (default: FOLDER/cutaway.png)")
      ->type_name("FILE");
  return [of, request] { return draw_cutaway(*of, *request); };
}

Action add_batch(CLI::App& command) {
  const auto request = std::make_shared<BatchRequest>();
  add_mission_options(command, request->of);
  command.add_option("--seeds", request->seeds, "The seeds, as in 1..1000 or 3,5,9")->required();
  command.add_option("--shard", request->shard, "Only part I of N, for one of N machines")
      ->type_name("I/N");
  command.add_flag("--pile-only", request->pile_only, "Settle the piles, render nothing");
  command.add_option("--out", request->of.out, "Output folder (default: out/<script>_batch)")
      ->type_name("DIR");
  command.add_flag("--force", request->of.force, "Begin although the disk looks too small");
  add_jobs_options(command, request->jobs, request->of.options);
  return [request] { return run_batch(*request); };
}

Action add_suite(CLI::App& command) {
  const auto request = std::make_shared<SuiteRequest>();
  command.add_option("suite", request->suite, "The suite, a Lua script")->required();
  command.add_option("--out", request->out, "Output folder (default: out/<name of the suite>)")
      ->type_name("DIR");
  command.add_option("--junit", request->junit, "Write the results as JUnit XML")
      ->type_name("FILE");
  command.add_flag("--update", request->update, "Take the hashes of this run as the golden ones");
  add_list(command, "--only", request->only, "Only the runs of that name", "NAME");
  add_jobs_options(command, request->jobs, request->options);
  return [request] { return run_suite(*request); };
}

Action add_check(CLI::App& command) {
  const auto request = std::make_shared<RunRequest>();
  add_mission_options(command, *request);
  add_seed_option(command, *request);
  command.add_flag_callback(
      "--schema",
      [] {
        std::printf("%s\n", mission_json_schema().c_str());
        throw CLI::Success();
      },
      "Print a JSON Schema of every key of a mission instead");
  return [request] { return check_mission(*request); };
}

struct AssetsRequest {
  std::string pack, out;
  bool json = false;
  int tile = 288;
};

Action add_assets(CLI::App& command) {
  command.require_subcommand(1);
  const auto request = std::make_shared<AssetsRequest>();
  CLI::App* check = command.add_subcommand(
      "check", "Say what is sound in a pack: closed meshes, masses, how well the parts fit");
  CLI::App* show = command.add_subcommand("show", "Draw every asset of a pack on one sheet");
  for (CLI::App* each : {check, show})
    each->add_option("pack", request->pack, "A folder with a pack.lua, or a bundled pack")
        ->required();
  check->add_flag("--json", request->json, "JSON instead of a table");
  show->add_option("--out", request->out, "The picture, .png or .jpg (default: NAME.png)")
      ->type_name("FILE");
  show->add_option("--tile", request->tile, "Width of one asset's picture, in pixels")
      ->check(CLI::Range(64, 1024));
  return [request, check] {
    if (*check) return check_assets_of(request->pack, request->json);
    return show_assets(request->pack, request->out, request->tile);
  };
}

Action add_info(CLI::App& command) {
  const auto request = std::make_shared<InfoRequest>();
  command.add_flag("--gl", request->gl, "Every EGL device, what it gives, which is chosen and why");
  add_device_option(command, request->gl_device);
  return [request] { return print_info(*request); };
}

struct CommandEntry {
  const char* name;
  const char* text;
  Action (*add)(CLI::App&);
};

// Of this machine, or of what lies at some paths.
Action add_any_info(CLI::App& command) {
  const Action of_machine = add_info(command);
  const auto paths = std::make_shared<std::vector<std::string>>();
  command
      .add_option("path", *paths,
                  "Recordings, or folders of runs: what they hold, and whether they are whole")
      ->type_name("PATH");
  return [paths, of_machine] { return paths->empty() ? of_machine() : print_info_of(*paths); };
}

const CommandEntry kCommands[] = {
    {"run", "Run a mission to a finished dataset", add_run},
    {"settle", "Settle the pile of a mission, nothing more", add_settle},
    {"drive", "Fly the camera by hand in a window; what is driven becomes a mission", add_drive},
    {"resume", "Continue a run that was stopped or killed", add_resume},
    {"verify", "Run again from the manifest alone, and compare every hash", add_verify},
    {"render", "Another mission's flight over the pile of a finished run", add_render},
    {"export", "The pile of a finished run as STL, PLY, OBJ, glTF or SDF", add_export},
    {"cutaway", "Draw a run's pile cut open, to scale", add_cutaway},
    {"voids", "Map the voids of a run's pile: entrances, volumes, widest ways", add_voids},
    {"eval", "Score what others made of a dataset", add_eval},
    {"batch", "One mission with many seeds, and a table of them", add_batch},
    {"suite", "Many missions with what is expected of them, for CI", add_suite},
    {"assets", "Look into a pack of assets", add_assets},
    {"check", "Print the complete scenario as JSON; run nothing", add_check},
    {"info", "Print versions, the GL renderer and threads; or look over a dataset", add_any_info}};

// Says so where the first word is no command.
bool is_unknown_command(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  std::vector<std::string> names;
  for (const CommandEntry& entry : kCommands) names.push_back(entry.name);
  const bool known = std::find(names.begin(), names.end(), word) != names.end();
  if (word.empty() || word[0] == '-' || known) return false;
  const std::string near = nearest_name(word, names);
  std::fprintf(stderr, "no such command: `%s`%s\n`rubble --help` lists all\n",
               printable(word).c_str(),
               near.empty() ? "" : (" (did you mean `" + near + "`?)").c_str());
  return true;
}

// A descriptor that is closed would become the number of the first file that is opened, and what is
// printed would go into that. One that only reads in its place makes printing fail, as it should.
void reserve_standard_files() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) open("/dev/null", O_RDONLY);
}

// What was printed is a result: a full disk must not look like success.
ExitCode check_standard_output(ExitCode code) {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  const std::string reason = errno ? ": " + std::generic_category().message(errno) : "";
  std::fprintf(stderr, "\nrubble: cannot write to standard output%s\n", reason.c_str());
  return code == ExitCode::done ? ExitCode::failure : code;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Simulates collapsed structures: a seed and a Lua mission give a settled pile, a "
      "camera flight, RGB-D frames, an MRPT rawlog, a ROS bag and the ground truth."};
  app.footer(
      "Exit codes: 0 done, 1 bad input, 2 failure, 3 finished but did not settle, 4 stopped by "
      "a signal, 5 not the same.");
  app.set_version_flag("--version", "rubble " + build_info().version);
  app.require_subcommand(1);
  Commands commands;
  for (const CommandEntry& entry : kCommands) {
    CLI::App* const command = app.add_subcommand(entry.name, entry.text);
    commands.emplace_back(command, entry.add(*command));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0 && is_unknown_command(argc, argv)) return ExitCode::bad_input;
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::bad_input;
  }
  for (const auto& [command, action] : commands)
    if (*command) return action();
  return ExitCode::bad_input;
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  using rubble::ExitCode;
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then an error of write(), like a full disk
  rubble::reserve_standard_files();
  try {
    return int(rubble::check_standard_output(rubble::run(argc, argv)));
  } catch (const rubble::InputError& error) {
    std::fprintf(stderr, "\n%s\n", error.what());
    return int(ExitCode::bad_input);
  } catch (const rubble::Stopped& stopped) {
    std::fprintf(stderr, "\n%s\n", stopped.what());
    return int(ExitCode::stopped);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "\nrubble: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "\nrubble: %s\n", rubble::printable(error.what()).c_str());
  }
  return int(ExitCode::failure);
}
