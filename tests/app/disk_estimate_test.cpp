// What is said before a run against what lies there afterwards, for every output there is.
#include "app/estimate/disk_estimate.h"

#include <gtest/gtest.h>

#include "scripting/mission.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace disk_estimate_test {

using Sizes = std::map<std::string, std::uint64_t>;

// Every file and every channel: a new one without an estimate fails the test.
const char* const kEverything = R"(return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 30, spawn_position = { 0, 0, 2 }, spawn_bounds = { 2, 2, 2 } },
  camera = { width = 160, height = 120, stereo_baseline = 0.1, quality = "draft",
             channels = { "normals", "instance", "label", "flow", "sky_visibility" } },
  depth_sensor = { type = "structured_light" },
  event_camera = { on = true },
  imu = { on = true },
  trajectory = { rate_hz = 10, plan = "refuse", waypoints = {
    { t = 0, position = { -4, 0, 1.2 }, look_at = { 0, 0, 0.2 } },
    { t = 0.5, position = { -3.4, 0.6, 1.4 }, look_at = { 0, 0, 0.2 } } } },
  outputs = { mcap = true, tum = true, euroc = true, colmap = true, frames = true, depth = "32FC1",
              meshes = { "ply", "obj", "glb", "sdf" }, track = true },
  record_settling = { rate_hz = 2, to = 1 },
}
)";

// Of the folder's files, under the names of the outputs that they belong to.
Sizes measure(const std::filesystem::path& folder) {
  Sizes sizes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      sizes[entry.path().lexically_relative(folder).begin()->string()] += entry.file_size();
  return sizes;
}

// How much smaller than said an output may be. What packs pictures, or leaves some out, depends on
// them.
double allowed_factor(const std::string& name) {
  for (const char* packed :
       {"tum", "euroc", "colmap", "frames", "mission.simplemap", "mission.mcap"})
    if (name == packed) return 6;
  // Small ones, whose estimate is that of the largest that they can be.
  for (const char* small :
       {"preview.png", "manifest.json", "labels.csv", "pile.mtl", "flight.json"})
    if (name == small) return 200;
  return 5;
}

TEST(DiskEstimate, HoldsForEveryOutput) {
  const ScratchFolder scratch;
  write_file(scratch / "all.lua", kEverything);
  const Mission mission = load_mission(scratch / "all.lua");
  const Sizes said = estimate_outputs(mission.scenario, load_assets(mission, {}));
  const Outcome run = run_rubble("run " + (scratch / "all.lua") + " --out " + (scratch / "a"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Sizes found = measure(scratch / "a");
  std::uint64_t sum_said = 0, sum_found = 0;
  for (const auto& [name, bytes] : found) {
    ASSERT_TRUE(said.count(name)) << name << " has no estimate";
    const double factor = double(said.at(name)) / double(bytes);
    EXPECT_GE(factor, 1) << name << ": " << bytes << " bytes, said " << said.at(name);
    EXPECT_LE(factor, allowed_factor(name)) << name << ": " << bytes << " bytes";
    sum_found += bytes, sum_said += said.at(name);
  }
  for (const auto& item : said) EXPECT_TRUE(found.count(item.first)) << item.first;
  // The sheet's bound is for pictures of any size.
  EXPECT_LE(double(sum_said) - 6e6, 5 * double(sum_found));
}

// Of a building that falls on its furniture: pieces, joints between them and all meshes.
TEST(DiskEstimate, HoldsForABuilding) {
  const ScratchFolder scratch;
  write_file(scratch / "house.lua", R"(return rubble.mission {
  packs = { "residential" },
  pile = rubble.building { storeys = 1, bays_x = 1, bays_y = 1, furniture = { { asset = "table", per_bay = 1.5 } },
                           cause = { weak_storey = 0, weakness = 0.05 } },
  outputs = { meshes = { "ply", "obj", "glb", "sdf" } },
})");
  const Mission mission = load_mission(scratch / "house.lua");
  const AssetLibrary assets = load_assets(mission, {});
  const Sizes said = estimate_files(mission.scenario, assets, true);
  const Outcome run = run_rubble("settle " + (scratch / "house.lua") + " --out " + (scratch / "a"));
  const std::string pieces = std::to_string(int(count_building_pieces(mission.scenario.pile, assets)));
  EXPECT_NE(run.err.find(pieces + " pieces; at most"), std::string::npos) << pieces << "\n" << run.err;
  const Sizes found = measure(scratch / "a");
  EXPECT_GT(found.at("pile.bin"), 5000u);  // more than a pile without pieces has
  for (const auto& [name, bytes] : found) {
    ASSERT_TRUE(said.count(name)) << name << " has no estimate";
    EXPECT_GE(said.at(name), bytes) << name;
    EXPECT_LE(double(said.at(name)), allowed_factor(name) * double(bytes)) << name;
  }
}

// Of a robot with a camera: its way is known only after the drive. At a low rate, as in the tutorial, the robot's own
// messages are most of a recording.
TEST(DiskEstimate, HoldsForACameraOnARobot) {
  const ScratchFolder scratch;
  for (const char* camera :
       {"camera = { width = 160, height = 120 }, trajectory = { rate_hz = 1, ride = { robot = 'rover' } }",
        "cameras = { front = { width = 160, height = 120, rate_hz = 2, ride = { robot = 'rover' } } }, "
        "outputs = { preview = false }"}) {
    write_file(scratch / "ride.lua", std::string(R"(return rubble.mission {
  seed = 3, pile = { layers = 1, pieces_per_layer = 10, spawn_position = { 0, 0, 2 }, spawn_bounds = { 2, 2, 2 } },
  robots = { rubble.robot.rover { name = "rover", position = { -4, 0, 0.001 },
                                 drive = { { t = 0, linear = 1, angular = 0.4 } } } },
  robot_run = { duration = 6 },
  )") + camera + " }");
    const Mission mission = load_mission(scratch / "ride.lua");
    const Sizes said = estimate_outputs(mission.scenario, load_assets(mission, {}));
    const Outcome run = run_rubble("run " + (scratch / "ride.lua") + " --force --out " + (scratch / "a"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Sizes found = measure(scratch / "a");
    EXPECT_TRUE(found.count("robots"));
    for (const auto& [name, bytes] : found) {
      ASSERT_TRUE(said.count(name)) << name << " has no estimate";
      EXPECT_GE(said.at(name), bytes) << name << ": " << camera;
      EXPECT_LE(double(said.at(name)), allowed_factor(name) * double(bytes)) << name << ": " << camera;
    }
  }
}

// The defaults, and a picture packed into messages.
TEST(DiskEstimate, CountsWhatIsAskedForAndNothingElse) {
  const auto estimate = [](const std::string& more) {
    const Mission mission = load_mission_text(
        "return rubble.mission { camera = { width = 64, height = 48 }, pile = { layers = 1, "
        "pieces_per_layer = 10 }" +
            more + " }",
        "m.lua");
    return estimate_outputs(mission.scenario, load_assets(mission, {}));
  };
  const Sizes usual = estimate("");
  EXPECT_TRUE(usual.count("mission.bag"));
  EXPECT_FALSE(usual.count("mission.mcap"));
  EXPECT_FALSE(usual.count("frames"));
  const Sizes less = estimate(", outputs = { bag = false, stl = false, preview = false }");
  EXPECT_FALSE(less.count("mission.bag"));
  EXPECT_FALSE(less.count("pile.stl"));
  EXPECT_FALSE(less.count("preview.png"));
  const Sizes more = estimate(", imu = { on = true, rate_hz = 1000 }");
  EXPECT_GT(more.at("mission.rawlog"), usual.at("mission.rawlog"));
}

// A path that only the pile decides, and articulated pieces, which are several.
TEST(DiskEstimate, IsThereForPathsIntoVoidsAndAssemblies) {
  for (const char* script : {"deepest_void", "articulated"}) {
    const Mission mission =
        load_mission(RUBBLE_SOURCE_DIR "/scripts/" + std::string(script) + ".lua");
    const AssetLibrary assets = load_assets(mission, {});
    EXPECT_GT(estimate_bytes(mission.scenario, assets), 1000000u) << script;
    EXPECT_LT(estimate_bytes(mission.scenario, assets, true),
              estimate_bytes(mission.scenario, assets))
        << script;
  }
}

}  // namespace disk_estimate_test
}  // namespace rubble::testing
