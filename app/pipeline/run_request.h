// What a person asked for on the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rubble {

// What goes over a network while frames are drawn; nothing unless asked (docs/live.md).
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

// How to run, whatever is run: none of it changes a result.
struct RunOptions {
  int threads = 0;               // --threads; 0: all processors
  bool quiet = false;            // --quiet: no progress
  int gl_device = -1;            // --gl-device, see GlContextOptions
  double checkpoint_every = 10;  // --checkpoint-every, while settling; unit: s
  LiveRequest live;
};

struct RunRequest {
  std::string mission;                   // path of the Lua script
  std::optional<std::uint64_t> seed;     // --seed; overrides the script's
  std::vector<std::string> overrides;    // --set key=value, in order
  std::vector<std::string> asset_packs;  // --assets DIR, in order
  std::string out;                       // --out; empty: out/<name of the script>
  bool force = false;                    // --force: replace an earlier run's files
  RunOptions options;
};

struct InfoRequest {
  bool gl = false;     // --gl: every way to draw, and the device's limits
  int gl_device = -1;  // --gl-device
};

// For the commands that start from a folder of a run.
struct FolderRequest {
  std::string folder;
  std::vector<std::string> asset_packs;  // --assets DIR: where its packs may be now
  RunOptions options;
};

// Into which formats a pile goes, and where to.
struct ExportRequest {
  std::vector<std::string> formats;  // --format, of export_formats(); empty: all
  std::string out;                   // --out; empty: `export` in the folder of the run
  bool force = false;                // --force
};

// A picture of the pile, cut open across Y.
struct CutawayRequest {
  double y = 0;        // --y, of the plane; what is in front of it is taken away; unit: m
  int width = 900;     // --width; unit: pixel
  std::string title;   // --title, printed above
  std::string out;     // --out; empty: cutaway.png in the folder of the run
};

// How to look for voids.
struct VoidRequest {
  std::vector<double> radii{0.1, 0.2, 0.3};  // --radius, of robots; unit: m
  double voxel = 0.02;                       // --voxel; unit: m
  double outside_radius = 2;                 // --outside-radius: see kernel/voids/void_space.h
  double memory_gib = 4;                     // --memory
  int surfaces = 20;                         // --surfaces: the largest voids of each radius, as PLY
  std::string out;                           // --out; empty: `voids` in the folder of the run
  bool force = false;                        // --force
};

struct TrajectoryRequest {
  std::string estimate, truth;   // TUM or EuRoC files
  int delta = 1;                 // --delta: poses between which relative errors are taken
  double max_difference = 0.01;  // --max-difference: of the stamps of a pair; unit: s
  bool json = false;             // --json
};

// Where scores go.
struct ScoreOutput {
  std::vector<std::string> files;  // --out: .csv, .json or .tex
  bool json = false;               // --json: on standard output
};

struct SfmRequest {
  std::vector<std::string> datasets;     // folders of runs
  std::string model = "sfm/sparse";      // --model: inside each, or absolute
  double bound = 0.1;                    // --bound: on track are frames nearer than this; unit: m
  std::string details;                   // --details: folder for aligned points and tracks
  std::vector<std::string> asset_packs;  // --assets DIR: where its packs may be now
  ScoreOutput output;
};

struct SurfaceRequest {
  std::string dataset, mesh;             // the folder of a run; a PLY file
  std::string align;                     // --align: COLMAP model whose frame the mesh has
  std::vector<std::string> asset_packs;  // --assets
  ScoreOutput output;
};

struct MapRequest {
  std::string map, dataset;                  // a PLY file; the folder of a run
  std::string align;                         // --align: COLMAP model whose frame the map has
  std::vector<double> radii{0.1, 0.2, 0.3};  // --radius, of robots; unit: m
  double voxel = 0.05;                       // --voxel, of the map's free space; unit: m
  double outside_radius = 2;                 // --outside-radius: see kernel/voids/void_space.h
  std::optional<double> range;               // --range: of the camera's depth; unit: m
  double memory_gib = 4;                     // --memory, of the free space
  std::string details;                       // --details: folder for clouds and the entrances
  std::vector<std::string> asset_packs;      // --assets
  ScoreOutput output;
  RunOptions options;
};

}  // namespace rubble
