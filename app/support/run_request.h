// What a person asked for on the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/support/progress.h"

namespace rubble {

// What goes over a network while frames are drawn; nothing unless asked (docs/how_to/live.md).
struct LiveRequest {
  bool ros1 = false;       // --ros1
  std::string ros_master;  // --ros-master
  std::string ros_ip;      // --ros-ip
  bool ros2 = false;              // --ros2
  std::optional<int> ros_domain;  // --ros-domain
  std::string ros_interface;      // --ros-interface
  double rate = 1;         // --rate, of simulation time to the wall's; 0: as fast as frames come
  double wait = 0;         // --wait-for-subscribers; unit: s
};

// How to run, whatever is run: none of it but the device changes a result.
struct RunOptions {
  int threads = 0;               // --threads; 0: all processors
  bool quiet = false;            // --quiet: no progress
  std::string device;            // --device, as read_device() takes it; "": as $RUBBLE_DEVICE or the mission says
  double checkpoint_every = 10;  // --checkpoint-every, while settling; unit: s
  LiveRequest live;              // publishing while it runs; off by default
};

struct RunRequest {
  std::string mission;                   // path of the Lua script
  std::optional<std::uint64_t> seed;     // --seed; overrides the script's
  std::vector<std::string> overrides;    // --set key=value, in order
  std::vector<std::string> asset_packs;  // --assets DIR, in order
  bool track = false;                    // --track: as --set outputs.track=true
  std::string out;                       // --out; empty: out/<name of the script>
  bool force = false;                    // --force: replace an earlier run's files
  bool preview = false;                  // --preview: say what it will take, and run nothing
  RunOptions options;                    // of this run
};

// For the commands that start from a folder of a run.
struct FolderRequest {
  std::string folder;                    // of a finished or unfinished run
  std::vector<std::string> asset_packs;  // --assets DIR: where its packs may be now
  RunOptions options;                    // of what is done with it
};

// How a run is done and who is told of it, as apart from what is run: none of it changes a result.
struct RunContext {
  explicit RunContext(const RunOptions& asked);

  const RunOptions options;           // as they were asked for
  Progress progress;                  // what a person sees meanwhile
  std::vector<std::string> warnings;  // what is likely not as it was meant, for a person

  int threads() const;  // as asked, or all processors; at least 1
};

}  // namespace rubble
