// What is handed on with a dataset: checksums that sha256sum takes, a card, settings of other programs.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "app/card/dataset_card.h"
#include "app/card/slam_settings.h"
#include "kernel/base/error.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace pack_test {

namespace fs = std::filesystem;

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

class Pack : public ::testing::Test {
 protected:
  void run_tiny(const std::string& more) {
    write_file(scratch / "tiny.lua", kTinyMission);
    const Outcome run = run_rubble("run " + (scratch / "tiny.lua") + " --quiet --out " + folder + " " + more);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  ScratchFolder scratch;
  const std::string folder = scratch / "a";
};

TEST_F(Pack, CardAndChecksumsSayWhatIsThere) {
  run_tiny("");
  const Outcome packed = run_rubble("pack " + folder + " --card --licence CC-BY-4.0 --title 'Bricks: \"a\" heap'");
  ASSERT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_EQ(packed.out, folder + "/README.md\n" + folder + "/SHA256SUMS\n");
  const std::string check = "cd " + folder + " && sha256sum --quiet -c SHA256SUMS 2>&1 >sums";
  EXPECT_EQ(std::system(check.c_str()), 0) << read_file(folder + "/sums");
  const std::string card = read_file(folder + "/README.md");
  for (const std::string& part :
       {std::string("pretty_name: \"Bricks: \\\"a\\\" heap\""), std::string("license: \"CC-BY-4.0\""),
        std::string("16 pieces of a collapsed structure, at rest"), std::string("64 x 48 at 10 Hz, 3 frames"),
        std::string("| `mission.bag` | "), "state hash `" + read_state_hash(folder) + "`",
        std::string("- `concrete`"), std::string("from seed 3")})
    EXPECT_IN(part, card);
  EXPECT_FALSE(fs::exists(folder + "/settings"));
  // The dataset is as it was, and a change is found.
  EXPECT_EQ(run_rubble("info " + folder).exit_code, 0);
  write_file(folder + "/groundtruth.txt", "0");
  EXPECT_NE(std::system(check.c_str()), 0);
}

// The rule as anybody may write it down again from the card.
std::string split_by_python(int seeds, int train, int val) {
  const ScratchFolder scratch;
  write_file(scratch / "rule.py",
             "import hashlib\nfor seed in range(" + std::to_string(seeds) + "):\n"
             "    n = int(hashlib.sha256(b'rubble split %d' % seed).hexdigest()[:8], 16) % 100\n"
             "    print(0 if n < " + std::to_string(train) + " else 1 if n < " + std::to_string(train + val) + " else 2)\n");
  EXPECT_EQ(std::system(("/usr/bin/python3 " + (scratch / "rule.py") + " >" + (scratch / "out")).c_str()), 0);
  return read_file(scratch / "out");
}

TEST(Splits, FollowFromTheSeedByTheRuleOfTheCardInTheStatedShares) {
  for (const SplitShares shares : {SplitShares{}, SplitShares{50, 20, 30}, SplitShares{0, 100, 0}}) {
    std::string found;
    std::array<int, 3> counts{};
    for (int seed = 0; seed < 4000; ++seed) {
      const int split = split_of(std::uint64_t(seed), shares);
      found += std::to_string(split) + "\n";
      ++counts.at(std::size_t(split));
    }
    EXPECT_EQ(found, split_by_python(4000, shares.train, shares.val));
    for (std::size_t i = 0; i < 3; ++i) {  // within four deviations of a binomial distribution
      const double p = shares.as_list()[i] / 100.0;
      EXPECT_NEAR(counts[i], 4000 * p, 4 * std::sqrt(4000 * p * (1 - p))) << kSplits[i];
    }
  }
}

TEST(Splits, RefusesSharesThatAreNone) {
  EXPECT_EQ(parse_shares("60,25,15").as_list(), (std::array<int, 3>{60, 25, 15}));
  for (const char* text : {"", "80,10", "80,10,11", "80,10,10,0", "-10,100,10", "80;10;10", "80,10,10%", "a,b,c"}) {
    try {
      parse_shares(text);
      ADD_FAILURE() << text << " was taken";
    } catch (const InputError& error) {
      EXPECT_IN("--splits: not shares of a dataset: expected three whole numbers", std::string(error.what()));
    }
  }
}

TEST_F(Pack, OfABatchHasItsSplitsInTheCardAndAsFiles) {
  write_file(scratch / "tiny.lua", kTinyMission);
  const Outcome ran = run_rubble("batch " + (scratch / "tiny.lua") + " --pile-only --quiet --seeds 1..6 "
                                 "--vary settle.gravity=9.8,1.6 --out " + folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Outcome packed = run_rubble("pack " + folder + " --card --licence CC0-1.0 --splits 50,50,0");
  ASSERT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_EQ(packed.err, "") << "nobody asked for a test split";
  const SplitShares halves{50, 50, 0};
  std::array<std::string, 3> expected;
  for (int variant = 1; variant <= 2; ++variant)
    for (int seed = 1; seed <= 6; ++seed)
      expected.at(std::size_t(split_of(std::uint64_t(seed), halves))) +=
          "v" + std::to_string(variant) + "_seed_" + std::to_string(seed) + "\n";
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(read_file(folder + "/splits/" + kSplits[i] + ".txt"), expected[i]);
  EXPECT_FALSE(expected[0].empty() || expected[1].empty()) << "the test wants seeds in both";
  const std::string card = read_file(folder + "/README.md");
  EXPECT_IN("12 runs of `tiny.lua`, seeds 1..6, 12 `done`", card);
  EXPECT_IN("| `settle.gravity` | 1.6, 9.8 |", card);
  EXPECT_IN("`train` if n < 50, `val` if n < 100, else `test`", card);
  EXPECT_IN("| `test` | 0 % | 0 | 0 | `splits/test.txt` |", card);
  // Every file of every run is in the sums, and a change is found.
  const std::string check = "cd " + folder + " && sha256sum --quiet -c SHA256SUMS >sums 2>&1";
  EXPECT_EQ(std::system(check.c_str()), 0) << read_file(folder + "/sums");
  EXPECT_IN("  v2_seed_6/pile.bin\n", read_file(folder + "/SHA256SUMS"));
  write_file(folder + "/v2_seed_6/pile.stl", "0");
  EXPECT_NE(std::system(check.c_str()), 0);
  // One run of it says where it belongs; a split without a seed is named; settings belong to one run.
  ASSERT_EQ(run_rubble("pack " + folder + "/v1_seed_3 --card").exit_code, 0);
  EXPECT_IN("Seed 3 is of `" + std::string(kSplits[std::size_t(split_of(3, {}))]) + "`.", read_file(folder + "/v1_seed_3/README.md"));
  EXPECT_IN("warning: splits/test.txt is empty", run_rubble("pack " + folder + " --card --force --splits 98,1,1").err);
  EXPECT_IN("settings belong to one run", run_rubble("pack " + folder + " --settings --force").err);
}

TEST_F(Pack, SettingsAreThoseOfTheMission) {
  const std::string mission = "--set imu.on=true --set camera.stereo_baseline=0.12 --set settle.gravity=9.8";
  run_tiny(mission);
  ASSERT_EQ(run_rubble("pack " + folder + " --settings").exit_code, 0);
  write_file(scratch / "s.json", run_rubble("check " + (scratch / "tiny.lua") + " " + mission).out);
  const std::string read = std::string("'" RUBBLE_SOURCE_DIR "/tests/app/settings_reader.py' ") + folder +
                           "/settings " + (scratch / "s.json") + " >" + (scratch / "read") + " 2>&1";
  EXPECT_EQ(std::system(read.c_str()), 0) << read_file(scratch / "read");
  // The control: another scenario is noticed.
  write_file(scratch / "s.json", run_rubble("check " + (scratch / "tiny.lua") + " " + mission +
                                            " --set camera.stereo_baseline=0.13").out);
  EXPECT_NE(std::system(read.c_str()), 0);
  EXPECT_IN("0.12 instead of 0.13", read_file(scratch / "read"));
}

// Every topic of the bag that can be shown, and none that it has not.
TEST_F(Pack, RvizAndFoxgloveHaveTheTopicsOfTheRecording) {
  const auto compare = [&](const std::string& at) {
    return std::system(("/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/viewer_settings_reader.py' " + at + " >" +
                        (scratch / "read") + " 2>&1").c_str());
  };
  run_tiny("--set camera.topic=/eye --set camera.stereo_baseline=0.1 --set imu.on=true --set imu.topic=/unit "
           "--set outputs.pictures=png");
  ASSERT_EQ(run_rubble("pack " + folder + " --settings").exit_code, 0);
  EXPECT_EQ(compare(folder), 0) << read_file(scratch / "read");
  // The control: settings of another mission are noticed.
  std::filesystem::copy(folder, scratch / "b", fs::copy_options::recursive);
  std::string rviz = read_file(scratch / "b/settings/ros1.rviz");
  rviz.replace(rviz.find("/eye/rgb"), 4, "/ear");
  write_file(scratch / "b/settings/ros1.rviz", rviz);
  EXPECT_NE(compare(scratch / "b"), 0);
  EXPECT_IN("/ear/rgb/image_raw/compressed is not in the bag", read_file(scratch / "read"));
  EXPECT_IN("leaves out /eye/rgb", read_file(scratch / "read"));
}

TEST_F(Pack, RvizShowsEveryCameraAndLidarOfARig) {
  const std::string mission = "run scripts/lidar.lua --quiet --set pile.pieces_per_layer=10 --set pile.layers=1 "
                              "--set trajectory.rate_hz=2 --out " + folder;
  ASSERT_EQ(run_rubble(mission).exit_code, 0);
  ASSERT_EQ(run_rubble("pack " + folder + " --settings").exit_code, 0);
  const std::string read = "/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/viewer_settings_reader.py' " + folder +
                           " >" + (scratch / "read") + " 2>&1";
  EXPECT_EQ(std::system(read.c_str()), 0) << read_file(scratch / "read");
  EXPECT_IN("PointCloud2", read_file(folder + "/settings/ros2.rviz"));
}

// Neither the default camera nor the default unit is in a mission with lists of them.
TEST_F(Pack, TheCardOfARigHasItsCamerasAndUnits) {
  write_file(scratch / "rig.lua", R"(return rubble.mission {
  pile = { layers = 0, placed = { { box = { 1, 1, 0.5 }, position = { 0, 0, 0.25 } } } },
  cameras = { front = { width = 64, height = 48, channels = { "label" } },
              aside = { width = 32, height = 24, rate_hz = 20, position = { 0, 0.1, 0 } } },
  imus = { inside = { rate_hz = 150 } }, outputs = { rawlog = false },
  trajectory = { rate_hz = 10, waypoints = { { t = 0, position = { -3, 0, 1 }, look_at = { 0, 0, 0 } },
                                             { t = 0.2, position = { -3, 0.1, 1 }, look_at = { 0, 0, 0 } } } } })");
  const Outcome run = run_rubble("run " + (scratch / "rig.lua") + " --quiet --out " + folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(run_rubble("pack " + folder + " --card --settings").exit_code, 0);
  const std::string card = read_file(folder + "/README.md");
  for (const char* part : {"colour camera `front` | 64 x 48 at 10 Hz |", "colour camera `aside` | 32 x 24 at 20 Hz |",
                           "frames | 8 of all cameras", "inertial unit | 150 Hz;", "per pixel `label`",
                           "`cameras/NAME/groundtruth.txt`"})
    EXPECT_IN(part, card);
  EXPECT_EQ(card.find("1024"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder + "/settings/openvins/estimator_config.yaml"));
  EXPECT_IN("update_rate: 150", read_file(folder + "/settings/kalibr/imu.yaml"));
  EXPECT_IN("rostopic: /inside", read_file(folder + "/settings/kalibr/imu.yaml"));
  EXPECT_IN("/inside.linear_acceleration.x", read_file(folder + "/settings/foxglove.json"));
}

// A camera on the rig, and one beside a unit on a robot.
Scenario rig_and_robot() {
  Scenario s;
  s.cameras.assign(2, MountedCamera{});
  s.cameras[0].name = "high", s.cameras[1].name = "low";
  s.cameras[0].named = s.cameras[1].named = true;
  s.cameras[1].ride.robot = "tank";
  s.imus.emplace_back();
  s.imus[0].name = "unit", s.imus[0].named = true, s.imus[0].ride.robot = "tank";
  return s;
}

TEST(Settings, AreOfTheFirstCameraThatHasAUnit) {
  Scenario s = rig_and_robot();
  auto files = make_slam_settings(s);
  EXPECT_IN("rostopic: /low/rgb/image_raw", files["kalibr/camchain.yaml"]);
  EXPECT_IN("rostopic: /unit", files["kalibr/imu.yaml"]);
  EXPECT_IN("camera_name: low", files["camera.yaml"]);
  EXPECT_EQ(files.count("openvins/estimator_config.yaml"), 1u);
  // A rig that rides on the same link moves with it, too.
  s.trajectory.ride.robot = "tank", s.trajectory.ride.link = "base_link", s.trajectory.ride.position = {0.3, 0, 0.2};
  s.imus[0].position = {0.1, 0, 0};
  EXPECT_IN("rostopic: /low/rgb/image_raw", make_slam_settings(s)["kalibr/camchain.yaml"]);
  files = make_slam_settings(s, {{"tank", "base_link"}});
  EXPECT_IN("rostopic: /high/rgb/image_raw", files["kalibr/camchain.yaml"]);
  // The unit is 0.2 m behind the camera and 0.2 m below.
  EXPECT_IN("T_cam_imu:\n  - [0.0, -1.0, 0.0, 0.0]\n  - [0.0, 0.0, -1.0, 0.2]\n  - [1.0, 0.0, 0.0, -0.2]", files["kalibr/camchain.yaml"]);
  s.imus.clear();
  files = make_slam_settings(s);
  EXPECT_IN("rostopic: /high/rgb/image_raw", files["kalibr/camchain.yaml"]);
  EXPECT_EQ(files.count("openvins/estimator_config.yaml") + files.count("kalibr/imu.yaml"), 0u);
}

TEST(Card, NamesNoFileThatTheMissionDoesNotAskFor) {
  Scenario s = rig_and_robot();
  EXPECT_IN(", on `tank` |", describe_sensors(s, 4));
  EXPECT_IN("`cameras/NAME/groundtruth.txt`", describe_truth(s, true));
  EXPECT_IN("as a mesh", describe_truth(s, true));
  s.outputs.groundtruth = s.outputs.stl = false;
  for (const char* part : {"groundtruth.txt", "mesh"}) EXPECT_EQ(describe_truth(s, true).find(part), std::string::npos) << part;
  EXPECT_EQ(describe_truth(s, false).find("at each stamp"), std::string::npos) << "of a pile alone";
}

// The unit and the camera at places and turns of their own, and topics that the mission names.
TEST_F(Pack, CalibrationFollowsThePlacesAndNamesOfTheMission) {
  run_tiny("--set camera.topic=/eye --set imu.on=true --set imu.topic=/unit --set imu.position.x=0.2 "
           "--set imu.position.z=-0.1 --set imu.rpy_deg.z=90");
  ASSERT_EQ(run_rubble("pack " + folder + " --settings").exit_code, 0);
  const std::string chain = read_file(folder + "/settings/kalibr/camchain.yaml");
  EXPECT_IN("rostopic: /eye/rgb/image_raw", chain);
  EXPECT_IN("rostopic: /unit", read_file(folder + "/settings/kalibr/imu.yaml"));
  // The unit's X is the body's left, so minus the picture's right; its Y is backwards; it is 0.2 m ahead of
  // the camera and 0.1 m below.
  EXPECT_IN("T_cam_imu:\n  - [-1.0, 0.0, 0.0, 0.0]\n  - [0.0, 0.0, -1.0, 0.1]\n  - [0.0, -1.0, 0.0, 0.2]\n"
            "  - [0.0, 0.0, 0.0, 1.0]", chain);
}

TEST_F(Pack, LeavesOutWhatTheMissionHasNotAndKeepsWhatIsThere) {
  run_tiny("");
  write_file(folder + "/README.md", "mine");
  const Outcome kept = run_rubble("pack " + folder + " --card");
  EXPECT_EQ(kept.exit_code, 1);
  EXPECT_IN("--force replaces it", kept.err);
  EXPECT_EQ(read_file(folder + "/README.md"), "mine");
  EXPECT_FALSE(fs::exists(folder + "/SHA256SUMS")) << "all or nothing";
  EXPECT_EQ(run_rubble("pack " + folder + " --card --settings --force").exit_code, 0);
  EXPECT_IN("license: \"not stated\"", read_file(folder + "/README.md"));
  EXPECT_TRUE(fs::exists(folder + "/settings/orbslam3.yaml"));
  EXPECT_FALSE(fs::exists(folder + "/settings/openvins")) << "there is no inertial unit";
  EXPECT_EQ(run_rubble("pack " + (scratch / "none")).exit_code, 1);
  EXPECT_EQ(run_rubble("pack " + folder + " --licence MIT").exit_code, 1) << "--card is needed";
}

}  // namespace pack_test
}  // namespace rubble::testing
