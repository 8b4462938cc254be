// What the command lines of several commands have in common, and the groups of commands that have a
// file of their own.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "app/commands/commands.h"

namespace rubble {

// What is done with a subcommand's request, once the parser has filled it.
using Action = std::function<ExitCode()>;

// Options that may be given several times, one value each.
CLI::Option* add_list(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                      const std::string& text, const std::string& type);

// name: "mission" for an argument, "--mission" for an option.
void add_mission_options(CLI::App& command, RunRequest& request,
                         const std::string& name = "mission");

void add_seed_option(CLI::App& command, RunRequest& request);

void add_threads_option(CLI::App& command, int& threads, const std::string& text);

void add_device_option(CLI::App& command, int& device);

void add_run_options(CLI::App& command, RunOptions& options);

// Who to publish to; `text` says what --ros1 does.
void add_ros_options(CLI::App& command, LiveRequest& live, const std::string& text);
// For commands that draw frames: publish them meanwhile.
void add_live_options(CLI::App& command, LiveRequest& live);

void add_output_options(CLI::App& command, RunRequest& request);

// For commands that begin with the folder of a run.
void add_folder_options(CLI::App& command, FolderRequest& request);

// Of commands that start several runs.
void add_jobs_options(CLI::App& command, int& jobs, RunOptions& options);

// Of commands that look for voids: of VoidRequest and MapRequest alike. voxel: its default.
template <typename Request>
void add_space_options(CLI::App& command, Request& request, const std::string& voxel) {
  command.add_option("--radius", request.radii, "Radius of a robot (default: 0.1, 0.2 and 0.3)")
      ->type_name("METRES")
      ->allow_extra_args(false)
      ->take_all();
  command.add_option("--voxel", request.voxel, "Edge of a voxel (default: " + voxel + ")")
      ->type_name("METRES");
  command
      .add_option("--outside-radius", request.outside_radius,
                  "Outside is what a ball of this radius reaches from the sky (default: 2)")
      ->type_name("METRES");
  command.add_option("--memory", request.memory_gib, "Refuse to need more (default: 4)")
      ->type_name("GIB");
}

// `rubble eval`.
Action add_eval(CLI::App& command);

}  // namespace rubble
