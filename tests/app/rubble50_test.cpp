// Rubble-50: the missions are those that the tool makes, sound, and settle to the expected piles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace rubble50_test {

namespace fs = std::filesystem;
const std::string kRoot = RUBBLE_SOURCE_DIR;

std::vector<std::string> missions() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(kRoot + "/scripts/rubble50"))
    if (const std::string name = file.path().filename().string(); name[0] <= '9') names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Rubble50, EveryMissionIsSoundAndMadeByItsTool) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "docs/explanation");
  fs::create_directories(scratch / "scripts/rubble50");
  fs::copy(kRoot + "/docs/explanation/rubble50.md", scratch / "docs/explanation/rubble50.md");
  fs::copy(kRoot + "/scripts/rubble50/suite.golden.json", scratch / "scripts/rubble50/suite.golden.json");
  ASSERT_EQ(std::system(("'" + kRoot + "/tools/rubble50.py' '" + scratch.path().string() + "'").c_str()), 0);
  EXPECT_EQ(read_file(scratch / "docs/explanation/rubble50.md"), read_file(kRoot + "/docs/explanation/rubble50.md"));
  EXPECT_EQ(read_file(scratch / "scripts/rubble50/suite.lua"), read_file(kRoot + "/scripts/rubble50/suite.lua"));
  const std::vector<std::string> names = missions();
  ASSERT_EQ(names.size(), 50u);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(read_file(kRoot + "/scripts/rubble50/" + names[i]), read_file(scratch / "scripts/rubble50" + ("/" + names[i])));
    if (i % 6 != 0) continue;  // every structure or its neighbour, every condition and carrier
    const Outcome checked = run_rubble("check scripts/rubble50/" + names[i]);
    EXPECT_EQ(checked.exit_code, 0) << names[i] << "\n" << checked.err;
    EXPECT_NE(checked.out.find("\"seed\": " + std::to_string(i + 1)), std::string::npos) << names[i];
  }
}

// The table that papers compare with: a change of the kernel that moves a pile changes its hash in the same commit, by
// `rubble suite scripts/rubble50/suite.lua --update` and tools/rubble50.py.
void expect_hashes(const std::string& only, const std::string& passed) {
  const ScratchFolder scratch;
  const Outcome suite = run_rubble("suite scripts/rubble50/suite.lua --quiet --out " + (scratch / "out") + only);
  EXPECT_EQ(suite.exit_code, 0) << suite.out << suite.err;
  EXPECT_NE(suite.out.find(passed), std::string::npos) << suite.out;
}

TEST(Rubble50, PilesHaveTheExpectedHashes) {  // one of each structure
  std::string only;
  for (const char* name :
       {"01_heap_clear_orbit", "09_lean_to_dust_snake", "11_cantilever_clear_crawler", "17_v_shape_dark_snake",
        "21_a_frame_clear_snake", "26_pancake_clear_orbit", "31_inclined_clear_push", "36_lean_over_clear_crawler",
        "42_culvert_dark_snake", "46_curtain_clear_snake"})
    only += std::string(" --only ") + name;
  expect_hashes(only, "10 of 10 passed");
}
TEST(NightlyRubble50, PilesHaveTheExpectedHashes) { expect_hashes("", "50 of 50 passed"); }

// A robot that stands in a slab ends its mission with an error before the first image.
TEST(NightlyRubble50, EveryRobotHasRoomWhereItStarts) {
  const ScratchFolder scratch;
  int robots = 0;
  for (const std::string& name : missions()) {
    const bool rides = name.find("crawler") != std::string::npos || name.find("rover") != std::string::npos ||
                       name.find("snake") != std::string::npos;
    if (!rides) continue;
    ++robots;
    const Outcome run = run_rubble("run scripts/rubble50/" + name + " --quiet --force --out " + (scratch / "out") +
                                   " --set robot_run.duration=0.1 --set camera.width=16 --set camera.height=16");
    EXPECT_EQ(run.exit_code, 0) << name << "\n" << run.err;
  }
  EXPECT_EQ(robots, 30);
}

// The command of the baselines, on a recording of three frames that lies where the one of mission 2 would.
TEST(NightlyRubble50, BaselinesFollowARecordingAndFillTheTables) {
  if (std::system("/usr/bin/python3 -c 'import cv2.rgbd, open3d' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-opencv or python3-open3d is not installed";
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const std::string folder = scratch / "02_heap_dark_push", page = scratch / "page.md";
  ASSERT_EQ(run_rubble("run " + (scratch / "tiny.lua") + " --quiet --set camera.width=320 --set camera.height=240 --out " +
                       folder).exit_code, 0);
  fs::copy_file(kRoot + "/docs/explanation/rubble50.md", page);
  const std::string command = "'" + kRoot + "/bench/rubble50/run' --missions 2 --methods rgbd,icp,colmap --program '" RUBBLE_PROGRAM
                              "' --out " + scratch.path().string() + " --records " + (scratch / "records.jsonl") +
                              " --document " + page + " >" + (scratch / "log") + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(scratch / "log");
  EXPECT_NE(read_file(scratch / "log").find("02_heap_dark_push rgbd: 0 of 3 frames lost"), std::string::npos);
  // COLMAP finds a model of these frames or none: both are results.
  EXPECT_NE(read_file(scratch / "log").find("02_heap_dark_push colmap: "), std::string::npos);
  const std::string kept = read_file(scratch / "records.jsonl");
  const auto line = kept.find("\"rgbd\"]");
  ASSERT_NE(line, std::string::npos);
  const std::size_t start = kept.rfind('\n', line) + 1;
  const auto found = nlohmann::json::parse(kept.substr(start, kept.find('\n', line) - start)).at("result");
  EXPECT_EQ(found.at("trajectory").at("pairs"), 3);
  // The camera moved 0.14 m; a track in a wrong frame, or one that stands still, is farther off.
  EXPECT_LT(found.at("trajectory").at("ate_rmse_se3_m"), 0.02);
  EXPECT_LT(found.at("trajectory").at("rpe_trans_rmse_m"), 0.03);
  const std::string written = read_file(page);
  EXPECT_NE(written.find("| OpenCV `RgbdOdometry` | 1 of 50 | 1 | "), std::string::npos) << written;
  EXPECT_NE(written.find("| Open3D, hybrid term | 0 of 50 | 0 | - |"), std::string::npos);
  EXPECT_NE(written.find("| COLMAP | 1 of 50 | "), std::string::npos);
  EXPECT_NE(written.find("\n| 2 | 3 | "), std::string::npos);
  // Done once: a second call reads what is there.
  fs::remove_all(folder);
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_file(page), written);
}

}  // namespace rubble50_test
}  // namespace rubble::testing
