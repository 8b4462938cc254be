// The architecture as a test: who may include whom, and where each third-party library may appear.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace rubble {
namespace include_direction_test {

namespace fs = std::filesystem;

struct Include {
  fs::path file;  // relative to the root
  int line;
  std::string target;
};

// What a line includes; empty: nothing.
std::string target_of(const std::string& line) {
  const std::size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return "";
  const std::size_t word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string::npos || line.compare(word, 7, "include") != 0) return "";
  const std::size_t open = line.find_first_of("<\"", word);
  if (open == std::string::npos) return "";
  const std::size_t close = line.find_first_of(">\"", open + 1);
  return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

std::vector<Include> find_includes(const fs::path& root, const std::string& folder) {
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    std::string text;
    for (int line = 1; std::getline(in, text); ++line)
      if (const std::string target = target_of(text); !target.empty())
        includes.push_back({fs::relative(entry.path(), root), line, target});
  }
  return includes;
}

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes)
    if (starts_with(text, prefix)) return true;
  return false;
}

using Prefixes = std::vector<std::string>;

const Prefixes kFloors{"kernel/", "render/", "io/", "scripting/", "assets/", "app/", "bench/", "python/"};

// The first so many rooms of the kernel, from the ground up, and its base: each includes only what
// is below it.
Prefixes kernel_rooms(std::size_t count) {
  Prefixes rooms{"kernel/base/",      "kernel/model/",     "kernel/geometry/",
                 "kernel/structure/", "kernel/collision/", "kernel/multibody/",
                 "kernel/solver/",    "kernel/world/",     "kernel/settling/",
                 "kernel/robot/"};
  rooms.resize(count + 1);
  return rooms;
}

Prefixes with(Prefixes rooms, const Prefixes& more) {
  rooms.insert(rooms.end(), more.begin(), more.end());
  return rooms;
}

// What each room may include of ours. The first match of the file's name counts.
using Allowed = std::vector<std::pair<std::string, Prefixes>>;

const Allowed kKernel{
    {"kernel/base/", {"kernel/base/"}},
    {"kernel/model/", kernel_rooms(1)},
    {"kernel/geometry/", kernel_rooms(2)},
    {"kernel/structure/", kernel_rooms(3)},
    {"kernel/collision/", with(kernel_rooms(2), {"kernel/collision/"})},
    {"kernel/multibody/", with(kernel_rooms(2), {"kernel/collision/", "kernel/multibody/"})},
    {"kernel/solver/", with(kernel_rooms(2), {"kernel/collision/", "kernel/multibody/", "kernel/solver/"})},
    // What changes knows nothing of the phases of a step, and no phase of the world around them.
    {"kernel/world/state/", with(kernel_rooms(6), {"kernel/world/state/"})},
    {"kernel/world/phases/", with(kernel_rooms(6), {"kernel/world/state/", "kernel/world/phases/"})},
    {"kernel/world/", kernel_rooms(7)},
    {"kernel/settling/", kernel_rooms(8)},
    {"kernel/robot/", with(kernel_rooms(9), {"kernel/surroundings/"})},
    {"kernel/queries/", with(kernel_rooms(2), {"kernel/queries/"})},
    {"kernel/fines/", with(kernel_rooms(2), {"kernel/queries/", "kernel/fines/"})},
    {"kernel/surroundings/", with(kernel_rooms(2), {"kernel/surroundings/"})},
    {"kernel/voids/", with(kernel_rooms(2), {"kernel/queries/", "kernel/voids/"})},
};

// Rooms of a floor from the ground up: each includes itself, what is below it, and of the other
// floors `others`.
Allowed stack(const Prefixes& rooms, const Prefixes& others) {
  Allowed allowed;
  Prefixes below = others;
  for (const std::string& room : rooms) {
    below.push_back(room);
    allowed.emplace_back(room, below);
  }
  return allowed;
}

// Below what draws; then the interface of devices, and all that knows it alone.
const Prefixes kBelowDevices{"kernel/base/",      "render/shaders/",  "render/surface/", "render/scene/",   "render/streams/",
                             "render/camera/",    "render/materials/", "render/sky/",    "render/geometry/", "render/lighting/",
                             "render/shading/",   "render/media/",    "render/passes/",  "render/colour/",  "render/device/"};

Allowed render_rooms() {
  // Devices know nothing of each other, and OpenGL is known to one of them.
  Allowed rooms{{"render/gl/", {"kernel/base/", "render/gl/"}},
                {"render/devices/software/", with(kBelowDevices, {"render/devices/software/"})},
                {"render/devices/gl/", with(kBelowDevices, {"render/gl/", "render/devices/gl/"})},
                {"render/devices/", {"render/device/", "render/devices/", "render/scene/"}}};
  const Allowed others = stack(
      with(Prefixes(kBelowDevices.begin() + 1, kBelowDevices.end()),
           {"render/transport/", "render/reference/", "render/view/", "render/renderer.", "render/optics/",
            "render/sensors/", "render/rays/", "render/lidar/"}),
      {"kernel/base/"});
  rooms.insert(rooms.end(), others.begin(), others.end());
  return rooms;
}

const Allowed kRender = render_rooms();

const Allowed kIo = stack(
    {"io/base/", "io/image/", "io/import/", "io/mesh_formats/", "io/mesh/", "io/state/", "io/robot/", "io/scenes/", "io/recording/", "io/ros/", "io/mrpt/",
     "io/datasets/", "io/learning/", "io/playback/", "io/live/"},
    {"kernel/base/", "kernel/model/fines.h", "kernel/model/pile_state.h", "kernel/model/pile.h", "kernel/model/track.h", "kernel/model/robot.h",
     "kernel/model/assembly.h", "kernel/geometry/hull.h", "kernel/geometry/lattice_hull.h",
     "kernel/settling/settle_checkpoint.h", "render/scene/", "render/streams/image_streams.h"});

// Of voids and ways through them.
const Allowed kVoidFiles = stack({"io/base/", "io/image/", "io/voids/", "io/ompl/"},
                                 {"kernel/base/", "kernel/geometry/voxel_grid.h", "kernel/voids/"});

// A kind of sensor is one file: with the messages that its readings are.
const Allowed kSensors{{"scripting/sensors/",
                        {"kernel/base/", "scripting/values/", "scripting/trajectory/", "scripting/schema/", "scripting/sensors/",
                         "io/recording/reading_format.h", "io/ros/ros_messages.h", "render/lidar/lidar.h", "render/scene/lidar_spec.h"}}};

// A robot is its files: with its model, and how it is commanded.
const Allowed kRobots{{"scripting/robots/",
                       {"kernel/base/", "kernel/model/", "kernel/geometry/mesh_builder.h", "kernel/robot/parts.h",
                        "kernel/robot/drive_commands.h", "scripting/values/", "scripting/schema/", "scripting/robots/"}}};

const Allowed kScripting = stack(
    {"scripting/values/", "scripting/trajectory/", "scripting/schema/", "scripting/files/", "scripting/sandbox/",
     "scripting/packs/", "scripting/sky/", "scripting/sensors/", "scripting/robots/", "scripting/scenario/", "scripting/reference/", "scripting/"},
    {"kernel/base/", "kernel/model/fines.h", "kernel/model/pile.h", "kernel/model/surroundings.h", "kernel/robot/step_rate.h",
     "kernel/settling/settle.h",
     "render/scene/",
     "render/streams/image_streams.h", "io/image/data_picture.h"});

const Allowed kApp = stack(
    {"app/support/", "app/formats/", "app/provenance/", "app/assets/", "app/measures/",
     "app/estimate/", "app/planning/", "app/victims/", "app/fines/", "app/surroundings/", "app/scene/", "app/mission/", "app/sensors/", "app/robots/", "app/control/", "app/simulators/", "app/session/", "app/pipeline/", "app/batch/", "app/report/", "app/card/",
     "app/eval/scores/", "app/eval/sfm/", "app/eval/map/", "app/search/", "app/navigate/", "app/navigate_ros1/", "app/view/", "app/drive/", "app/serve/", "app/command_line/",
     "app/commands/eval/", "app/commands/assets/", "app/commands/publish/", "app/commands/",
     "app/main.cpp"},
    {"kernel/", "render/", "io/", "scripting/", "assets/generator/"});

const Allowed kTop{{"assets/generator/", {"assets/generator/", "kernel/base/"}},
                   {"bench/", {"bench/", "kernel/", "render/", "io/", "scripting/", "app/"}},
                   {"python/", {"python/", "kernel/", "render/", "io/", "scripting/", "app/"}}};

const Allowed& allowed_of(const std::string& file) {
  if (starts_with(file, "kernel/")) return kKernel;
  if (starts_with(file, "render/")) return kRender;
  if (starts_with(file, "io/voids/") || starts_with(file, "io/ompl/")) return kVoidFiles;
  if (starts_with(file, "io/")) return kIo;
  if (starts_with(file, "scripting/sensors/")) return kSensors;
  if (starts_with(file, "scripting/robots/")) return kRobots;
  if (starts_with(file, "scripting/")) return kScripting;
  return starts_with(file, "app/") ? kApp : kTop;
}

// The row of the file's room; null: the file is in no room.
const Prefixes* find_row(const std::string& file) {
  for (const auto& [room, allowed] : allowed_of(file))
    if (starts_with(file, room)) return &allowed;
  return nullptr;
}

std::vector<std::string> find_crossings(const std::vector<Include>& includes) {
  std::vector<std::string> crossings;
  for (const Include& include : includes) {
    const std::string file = include.file.string();
    const std::string place = file + ":" + std::to_string(include.line);
    const Prefixes* const row = find_row(file);
    if (!row)
      crossings.push_back(file + " is in no room of this test: give its folder a place");
    else if (starts_with_any(include.target, kFloors) && !starts_with_any(include.target, *row))
      crossings.push_back(place + " includes " + include.target);
  }
  return crossings;
}

TEST(IncludeDirection, GoesOneWayOnly) {
  std::size_t seen = 0;
  for (const std::string& floor : kFloors) {
    const std::vector<Include> includes = find_includes(RUBBLE_SOURCE_DIR, floor);
    seen += includes.size();
    for (const std::string& crossing : find_crossings(includes)) ADD_FAILURE() << crossing;
  }
  EXPECT_GT(seen, 100u);
}

TEST(IncludeDirection, TheCheckSeesACrossing) {
  const auto crossings = [](const char* file, const char* target) {
    return find_crossings({{file, 3, target}}).size();
  };
  EXPECT_EQ(crossings("kernel/world/world.cpp", "render/scene/scene.h"), 1u);
  EXPECT_EQ(crossings("kernel/solver/rows.h", "kernel/world/world.h"), 1u);
  EXPECT_EQ(crossings("kernel/world/world.cpp", "kernel/solver/rows.h"), 0u);
  EXPECT_EQ(crossings("kernel/world/state/bodies.h", "kernel/world/phases/step.h"), 1u);
  EXPECT_EQ(crossings("kernel/world/phases/sleep.cpp", "kernel/world/world.h"), 1u);
  EXPECT_EQ(crossings("io/datasets/tum.cpp", "render/renderer.h"), 1u);
  EXPECT_EQ(crossings("io/datasets/tum.cpp", "render/scene/frame.h"), 0u);
  EXPECT_EQ(crossings("io/base/compressed_file.cpp", "io/ros/ros_wire.h"), 1u);
  EXPECT_EQ(crossings("io/ros/bag_writer.cpp", "io/base/compressed_file.h"), 0u);
  EXPECT_EQ(crossings("io/voids/vdb_file.cpp", "io/ros/ros_wire.h"), 1u);
  EXPECT_EQ(crossings("render/renderer.cpp", "render/sensors/camera.h"), 1u);
  EXPECT_EQ(crossings("render/renderer.cpp", "render/devices/software/software_device.h"), 1u);
  EXPECT_EQ(crossings("render/devices/software/shadow_map.h", "render/devices/gl/gl_device.h"), 1u);
  EXPECT_EQ(crossings("render/view/lit_scene.h", "render/gl/gl.h"), 1u);
  EXPECT_EQ(crossings("render/sensors/camera.cpp", "render/renderer.h"), 0u);
  EXPECT_EQ(crossings("scripting/scenario/scenario.h", "scripting/mission.h"), 1u);
  EXPECT_EQ(crossings("app/mission/resolved_mission.cpp", "app/commands/inspect_dataset.h"), 1u);
  EXPECT_EQ(crossings("app/commands/run.cpp", "app/pipeline/run.h"), 0u);
  EXPECT_EQ(crossings("app/attic/run.cpp", "app/pipeline/run.h"), 1u);
}

// Each third-party header stays behind its door: the rooms or files that may include it.
const std::map<std::string, Prefixes> kDoors{
    {"Simbody.h", {"kernel/multibody/"}},
    {"SimTK", {"kernel/multibody/"}},
    {"xxhash.h", {"kernel/base/"}},
    {"openssl/", {"kernel/base/"}},
    {"embree", {"kernel/base/system/embree.h"}},
    {"render/gl/", {"render/gl/", "render/devices/gl/"}},
    {"render/devices/", {"render/devices/", "app/support/drawing_device.h", "bench/"}},
    {"EGL/", {"render/gl/"}},
    {"GL/", {"render/gl/"}},
    {"assimp/", {"io/mesh_formats/assimp_reader.cpp"}},
    {"draco/", {"io/mesh_formats/draco_decoder.cpp"}},
    {"expat.h", {"io/base/xml_document.cpp"}},
    {"nanobind/", {"python/"}},
    {"opencv2/", {"bench/images/picture_file.cpp", "io/image/", "io/recording/contact_sheet.cpp", "io/voids/void_picture.cpp"}},
    {"mrpt/", {"io/mrpt/", "io/playback/rawlog_pictures.cpp"}},
    {"rosbag/", {"io/ros/"}},
    {"sensor_msgs/", {"io/ros/"}},
    {"ros/", {"io/live/"}},
    {"xmlrpcpp/", {"io/live/"}},
    {"dds/", {"io/live/"}},
    {"openvdb/", {"io/voids/"}},
    {"octomap/", {"io/voids/"}},
    {"ompl/", {"io/ompl/"}},
    {"Imf", {"io/image/exr_file.cpp"}},
    {"png.h", {"io/image/image_file.cpp", "io/image/picture_decoder.cpp"}},
    {"tiff", {"io/image/tiff_data.cpp"}},
    {"webp/", {"io/image/data_picture.cpp"}},
    {"yaml-cpp/", {"scripting/files/yaml_value.cpp"}},
    {"jpeglib.h", {"io/image/image_file.cpp", "io/image/picture_decoder.cpp"}},
    {"zlib.h", {"io/base/compressed_file.cpp", "io/ros/mcap_format.h"}},
    {"lz4", {"io/ros/"}},
    {"zstd.h", {"io/ros/"}},
    {"lua", {"scripting/sandbox/lua_api.h"}},
    {"lauxlib.h", {"scripting/sandbox/lua_api.h"}},
    {"Eigen/", {"app/eval/scores/alignment.cpp"}},
    {"CLI/", {"app/command_line/command_line.cpp", "app/navigate_ros1/main.cpp", "bench/"}},
    {"SDL", {"app/drive/"}},
    {"ccd/", {"bench/"}},
    {"Clp", {"bench/equilibrium/"}},
    {"Coin", {"bench/equilibrium/"}},
    // The whole of it costs ten seconds in each unit: headers include json_fwd.hpp.
    {"nlohmann/json.hpp",
     {"app/batch/", "app/card/viewer_settings.cpp", "app/commands/", "app/drive/", "app/eval/", "app/mission/",
      "app/navigate/mission_to_drive.cpp", "app/navigate_ros1/main.cpp",
      "app/robots/robot_files.cpp", "app/planning/flight.cpp", "app/provenance/", "app/report/",
      "app/search/program_agent.cpp", "app/support/", "app/victims/place_victims.cpp", "app/view/", "bench/",
      "io/datasets/coco_recorder.cpp", "io/datasets/colmap_recorder.cpp", "io/datasets/frames_recorder.cpp",
      "io/datasets/nerfstudio_recorder.cpp", "io/datasets/webdataset_recorder.cpp", "io/learning/lerobot_dataset.cpp", "io/mesh_formats/gltf_document.h", "io/mesh/glb_writer.cpp", "io/recording/recording.cpp", "io/scenes/scene_text.cpp",
      "io/voids/void_json.cpp", "scripting/reference/json_schema.cpp",
      "scripting/scenario/scenario_json.cpp"}}};

bool is_of_system(const std::string& target) {
  return target.find('/') == std::string::npos && target.find('.') == std::string::npos;
}

std::vector<std::string> find_open_doors(const std::vector<Include>& includes) {
  std::vector<std::string> open;
  for (const Include& include : includes)
    for (const auto& [library, homes] : kDoors)
      if (starts_with(include.target, library) && !is_of_system(include.target) &&
          !starts_with_any(include.file.string(), homes))
        open.push_back(include.file.string() + ":" + std::to_string(include.line) + " includes " +
                       include.target + ", which belongs behind " + homes.front());
  return open;
}

TEST(IncludeDirection, ThirdPartiesStayBehindTheirDoor) {
  for (const std::string& floor : kFloors)
    for (const std::string& open : find_open_doors(find_includes(RUBBLE_SOURCE_DIR, floor)))
      ADD_FAILURE() << open;
  EXPECT_EQ(find_open_doors({{"io/datasets/tum.cpp", 3, "opencv2/core.hpp"}}).size(), 1u);
  EXPECT_EQ(find_open_doors({{"io/image/sheet.cpp", 3, "opencv2/core.hpp"}}).size(), 0u);
}

// Of the C library and the system: no library of others, so no door.
const Prefixes kSystemHeaders{"sys/",    "unistd.h", "fcntl.h",  "poll.h",    "dlfcn.h", "time.h", "malloc.h",
                              "net",     "arpa/",    "linux/",   "dirent.h",  "spawn.h", "regex.h", "termios.h",
                              "pthread", "sched.h",  "signal.h", "immintrin.h",
                              "emmintrin.h", "xmmintrin.h", "sanitizer/common_interface_defs.h",
                              "arm_neon.h", "stdio.h", "ifaddrs.h"};

// A library that nobody gave a door cannot slip in.
TEST(IncludeDirection, EveryThirdPartyHasADoor) {
  for (const std::string& floor : kFloors)
    for (const Include& include : find_includes(RUBBLE_SOURCE_DIR, floor)) {
      const std::string& target = include.target;
      if (is_of_system(target) || starts_with_any(target, kFloors) ||
          starts_with_any(target, kSystemHeaders) || target == "nlohmann/json_fwd.hpp")
        continue;
      bool known = false;
      for (const auto& [library, homes] : kDoors) known = known || starts_with(target, library);
      EXPECT_TRUE(known) << include.file << ":" << include.line << " includes " << target
                         << ", which has no row in kDoors";
    }
}

// docs/development/contributing.md shows every room.
TEST(Rooms, AreDrawn) {
  std::ifstream in(RUBBLE_SOURCE_DIR "/docs/development/contributing.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  const std::size_t begin = page.find("<!-- rooms"), end = page.find("<!-- end of rooms");
  ASSERT_LT(begin, end);
  const std::string drawing = page.substr(begin, end - begin);
  std::set<std::string> rooms;
  for (const std::string& floor : kFloors)
    for (const Include& include : find_includes(RUBBLE_SOURCE_DIR, floor))
      rooms.insert(fs::relative(include.file.parent_path(), fs::path(floor)).string());
  EXPECT_GT(rooms.size(), 40u);
  const std::set<std::string> parts_of_rooms{".", "base/system", "base/tables", "multibody/joints", "multibody/springs",
                                            "geometry/decomposing", "solver/rows", "structure/buildings", "structure/factor", "world/phases",
                                            "world/state"};
  for (const std::string& room : rooms) {
    if (parts_of_rooms.count(room)) continue;
    EXPECT_NE(drawing.find("\n  " + room), std::string::npos)
        << room << " is not in docs/development/contributing.md: run tools/draw_rooms.py";
  }
}

}  // namespace include_direction_test
}  // namespace rubble
