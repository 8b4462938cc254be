// Options that several commands share.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/command_line.h"
#include "app/support/run_request.h"

namespace rubble {

// name: "mission" for an argument by place, "--mission" for an option.
void add_mission_options(CommandLine& line, RunRequest& request,
                         const std::string& name = "mission");

void add_seed_option(CommandLine& line, RunRequest& request);
void add_track_option(CommandLine& line, RunRequest& request);

void add_threads_option(CommandLine& line, int& threads);

// For commands that draw.
void add_device_option(CommandLine& line, std::string& device);

// Of the image that a window shows; both must outlive the parsing and hold the default.
void add_size_option(CommandLine& line, int& width, int& height);

void add_quiet_option(CommandLine& line, bool& quiet);

// Where packs of a run may be now.
void add_packs_option(CommandLine& line, std::vector<std::string>& folders, const std::string& help);

// For commands that draw frames.
void add_run_options(CommandLine& line, RunOptions& options);

// For commands that settle, and whose run can be resumed.
void add_checkpoint_option(CommandLine& line, RunOptions& options);

// Who to publish to, ROS 1 or ROS 2; `text` says what --ros1 does.
void add_ros_options(CommandLine& line, LiveRequest& live, const std::string& text);
// For ROS 2 alone, without --ros2: where to, and how fast.
void add_served_options(CommandLine& line, LiveRequest& live);
// For commands that draw frames: publish them meanwhile.
void add_live_options(CommandLine& line, LiveRequest& live);

// For commands that begin with a mission.
void add_preview_option(CommandLine& line, RunRequest& request);

void add_output_options(CommandLine& line, RunRequest& request);

// For commands that begin with the folder of a run.
void add_folder_options(CommandLine& line, FolderRequest& request);

// Of commands that start several runs.
void add_jobs_options(CommandLine& line, int& jobs, RunOptions& options);

// How to look for voids: of `voids` and of `eval map`.
struct SpaceRequest {
  std::vector<double> radii{0.1, 0.2, 0.3};  // --radius, of robots; unit: m
  double voxel = 0.02;                       // --voxel, its edge; unit: m
  double outside_radius = 2;                 // --outside-radius: see kernel/voids/void_space.h
  double memory_gib = 4;                     // --memory; unit: GiB
};
void add_space_options(CommandLine& line, SpaceRequest& request);

// Where scores go.
struct ScoreOutput {
  std::vector<std::string> files;  // --out: .csv, .json or .tex
  bool json = false;               // --json: on standard output
};
void add_score_options(CommandLine& line, ScoreOutput& output);

}  // namespace rubble
