// The architecture as a test: who may include whom, and where each third-party library may appear.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace rubble {
namespace {

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

const std::vector<std::string> kFolders{"kernel/", "render/", "io/", "scripting/", "app/", "bench/"};

using Prefixes = std::vector<std::string>;

// The first so many rooms of the kernel, from the ground up, and its base: each includes only what
// is below it.
Prefixes kernel_rooms(std::size_t count) {
  Prefixes rooms{"kernel/base/",      "kernel/model/",  "kernel/geometry/", "kernel/collision/",
                 "kernel/multibody/", "kernel/solver/", "kernel/world/",    "kernel/settling/"};
  rooms.resize(count + 1);
  return rooms;
}

Prefixes with(Prefixes rooms, const Prefixes& more) {
  rooms.insert(rooms.end(), more.begin(), more.end());
  return rooms;
}

// What each folder may include of ours. The first match of the file's folder counts.
const std::vector<std::pair<std::string, std::vector<std::string>>> kAllowed{
    {"kernel/base/", {"kernel/base/"}},
    {"kernel/model/", kernel_rooms(1)},
    {"kernel/geometry/", kernel_rooms(2)},
    {"kernel/collision/", kernel_rooms(3)},
    {"kernel/multibody/", kernel_rooms(4)},
    {"kernel/solver/", kernel_rooms(5)},
    {"kernel/world/", kernel_rooms(6)},
    {"kernel/settling/", kernel_rooms(7)},
    {"kernel/queries/", with(kernel_rooms(2), {"kernel/queries/"})},
    {"kernel/voids/", with(kernel_rooms(2), {"kernel/queries/", "kernel/voids/"})},
    {"render/", {"render/", "kernel/base/"}},
    {"io/voids/", {"io/", "kernel/base/", "kernel/voids/"}},
    {"io/",
     {"io/", "kernel/base/", "kernel/model/pile_state.h", "kernel/model/pile.h",
      "kernel/settling/settle_checkpoint.h", "render/frame.h"}},
    {"scripting/",
     {"scripting/", "kernel/base/", "kernel/model/pile.h", "kernel/settling/settle.h",
      "render/scene.h", "render/frame.h", "render/camera_spec.h"}},
    {"app/", {"app/", "kernel/", "render/", "io/", "scripting/"}},
    {"bench/", {"bench/", "kernel/", "render/", "io/", "scripting/", "app/"}},
};

std::vector<std::string> find_crossings(const std::vector<Include>& includes) {
  std::vector<std::string> crossings;
  for (const Include& include : includes) {
    if (!starts_with_any(include.target, kFolders)) continue;
    for (const auto& [folder, allowed] : kAllowed) {
      if (!starts_with(include.file.string(), folder)) continue;
      if (!starts_with_any(include.target, allowed))
        crossings.push_back(include.file.string() + ":" + std::to_string(include.line) +
                            " includes " + include.target);
      break;
    }
  }
  return crossings;
}

TEST(IncludeDirection, GoesOneWayOnly) {
  std::size_t seen = 0;
  for (const std::string& folder : kFolders) {
    const std::vector<Include> includes = find_includes(RUBBLE_SOURCE_DIR, folder);
    seen += includes.size();
    for (const std::string& crossing : find_crossings(includes)) ADD_FAILURE() << crossing;
  }
  EXPECT_GT(seen, 100u);
}

TEST(IncludeDirection, TheCheckSeesACrossing) {
  EXPECT_EQ(find_crossings({{"kernel/world/world.cpp", 3, "render/scene.h"}}).size(), 1u);
  EXPECT_EQ(find_crossings({{"io/tum.cpp", 3, "render/renderer.h"}}).size(), 1u);
  EXPECT_EQ(find_crossings({{"io/tum.cpp", 3, "render/frame.h"}}).size(), 0u);
  EXPECT_EQ(find_crossings({{"kernel/solver/rows.h", 3, "kernel/world/world.h"}}).size(), 1u);
  EXPECT_EQ(find_crossings({{"kernel/world/world.cpp", 3, "kernel/solver/rows.h"}}).size(), 0u);
}

// Each third-party library stays behind its door; Embree serves light and queries.
TEST(IncludeDirection, ThirdPartiesStayBehindTheirDoor) {
  const std::map<std::string, std::string> door{
      {"Simbody.h", "kernel/multibody/"},  {"SimTK", "kernel/multibody/"},     {"EGL/", "render/"},
      {"GL/", "render/"},        {"assimp/", "io/"},
      {"opencv2/", "io/"},       {"mrpt/", "io/"},         {"rosbag/", "io/"},
      {"ros/", "io/live/"},      {"dds/", "io/live/"},   {"zstd.h", "io/"},        {"jpeglib.h", "io/"},
      {"openvdb/", "io/voids/"}, {"octomap/", "io/voids/"}, {"sensor_msgs/", "io/"},
      {"lua", "scripting/"},
      {"CLI/", "app/"},          {"SDL", "app/drive/"},          {"xxhash.h", "kernel/base/"}, {"openssl/", "kernel/base/"}};
  for (const std::string folder : {"kernel/", "render/", "io/", "scripting/", "app/"})
    for (const Include& include : find_includes(RUBBLE_SOURCE_DIR, folder))
      for (const auto& [library, home] : door)
        if (starts_with(include.target, library) && !starts_with(include.file.string(), home))
          ADD_FAILURE() << include.file << ":" << include.line << " includes " << include.target
                        << ", which belongs behind " << home;
  for (const std::string& folder : kFolders)
    for (const Include& include : find_includes(RUBBLE_SOURCE_DIR, folder))
      if (starts_with(include.target, "embree3/") &&
          !starts_with_any(include.file.string(), {"render/", "kernel/queries/query_tree.cpp"}))
        ADD_FAILURE() << include.file << ":" << include.line << " includes Embree";
}

}  // namespace
}  // namespace rubble
