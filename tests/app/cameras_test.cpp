// Missions with several cameras, by readers that are not ours: rosbag, MRPT's tools, the npm reader of
// MCAP files; and by closed forms: over the bare ground every depth must unproject to z = 0.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "tests/app/program.h"
#include "tests/app/tiny_run.h"
#include "tests/io/support.h"

namespace rubble::testing {
namespace cameras_test {

using Json = nlohmann::json;

// A rig over the bare ground that moves and turns; cameras of 12 and 8 Hz, mounted apart.
const char* const kGround = R"(
return rubble.mission {
  seed = 5,
  pile = { layers = 0 },
  cameras = {
    front = { width = 64, height = 48, fov_deg = 70, rate_hz = 12, position = { 0.2, 0, 0 },
              rpy_deg = { 0, 30, 0 } },
    left = { width = 48, height = 48, rate_hz = 8, position = { 0, 0.3, -0.1 },
             rpy_deg = { 0, 50, 90 }, channels = { "position" }, frame_id = "left_eye",
             topic = "/side/left" },
  },
  imu = { on = true, rate_hz = 100, position = { 0.1, 0, 0 } },
  trajectory = { waypoints = {
    { t = 0, position = { 0, 0, 2 }, rpy_deg = { 0, 0, 0 } },
    { t = 1, position = { 1, 0, 2 }, rpy_deg = { 0, 0, 40 } } } },
  outputs = { mcap = true, euroc = true, tum = true, frames = true, depth = "32FC1" },
})";

class Cameras : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    write_file(*folder_ / "m.lua", kGround);
    outcome_ = run_rubble("run " + (*folder_ / "m.lua") + " --quiet --out " + (*folder_ / "out"));
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err; }

  static std::string file(const std::string& name) { return *folder_ / ("out/" + name); }

  // What a command prints.
  static std::string read_with(const std::string& command) {
    const std::string to = *folder_ / "printed";
    const int status = std::system((command + " >" + to + " 2>&1").c_str());
    EXPECT_EQ(status, 0) << command << "\n" << read_file(to);
    return read_file(to);
  }
  static Json read_bag() {
    const std::string text =
        read_with("/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/read_cameras.py' " +
                  file("mission.bag") +
                  " /front/depth_registered/image /side/left/depth_registered/image");
    return Json::parse(text, nullptr, false);
  }

  static ScratchFolder* folder_;
  static Outcome outcome_;
};

ScratchFolder* Cameras::folder_ = nullptr;
Outcome Cameras::outcome_;

std::vector<std::int64_t> stamps_of_rate(double rate_hz, int count) {
  std::vector<std::int64_t> stamps;
  for (int k = 0; k < count; ++k)
    stamps.push_back(1'000'000'000 + std::llround(k * 1e9 / rate_hz));
  return stamps;
}

TEST_F(Cameras, EachHasItsOwnRateTopicsAndFrames) {
  const Json bag = read_bag();
  ASSERT_TRUE(bag.is_object());
  const Json& headers = bag["headers"];
  const auto stamps = [&](const char* topic) {
    return headers.at(topic)["stamps"].get<std::vector<std::int64_t>>();
  };
  EXPECT_EQ(stamps("/front/rgb/image_raw"), stamps_of_rate(12, 13));
  EXPECT_EQ(stamps("/front/depth_registered/image"), stamps_of_rate(12, 13));
  EXPECT_EQ(stamps("/side/left/rgb/image_raw"), stamps_of_rate(8, 9));
  EXPECT_EQ(stamps("/side/left/ground_truth/position/image"), stamps_of_rate(8, 9));
  EXPECT_EQ(stamps("/imu"), stamps_of_rate(100, 101));
  EXPECT_EQ(headers["/front/rgb/image_raw"]["frame"], "front_optical_frame");
  EXPECT_EQ(headers["/side/left/rgb/camera_info"]["frame"], "left_eye");
  EXPECT_EQ(headers["/imu"]["frame"], "imu_link");
  // The pose of the rig once an instant, though both cameras have a frame at every quarter of a second.
  std::vector<std::int64_t> all = stamps_of_rate(12, 13);
  for (const std::int64_t stamp : stamps_of_rate(8, 9)) all.push_back(stamp);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  EXPECT_EQ(all.size(), 13u + 9 - 5);
  EXPECT_EQ(stamps("/ground_truth/pose"), all);
  EXPECT_EQ(headers.count("/camera/rgb/image_raw"), 0u);
}

TEST_F(Cameras, TransformsLeadFromEachCameraToTheRig) {
  const Json fixed = read_bag()["fixed"];
  EXPECT_EQ(fixed, (Json{{"front_link", "base_link"},
                         {"front_optical_frame", "front_link"},
                         {"left_link", "base_link"},
                         {"left_eye", "left_link"},
                         {"imu_link", "base_link"}}));
}

// By the transforms and intrinsics of the bag, and by where the mission says that the cameras are: at
// the end the rig is at (1, 0, 2), turned by 40 degrees.
TEST_F(Cameras, DepthOfEachLiesOnTheGround) {
  const Json planes = read_bag()["planes"];
  for (const char* topic : {"/front/depth_registered/image", "/side/left/depth_registered/image"}) {
    EXPECT_GT(planes[topic]["points"].get<int>(), 5000) << topic;
    EXPECT_LT(planes[topic]["worst"].get<double>(), 1e-4) << topic;
  }
  const auto expect = [](const Json& eye, const std::vector<double>& wanted) {
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_NEAR(eye[i].get<double>(), wanted[i], 1e-6) << i;
  };
  const Json& front = planes["/front/depth_registered/image"]["eyes"];
  const Json& left = planes["/side/left/depth_registered/image"]["eyes"];
  const double deg = std::acos(-1.0) / 180;
  const auto axis = [&](double yaw, double down) {  // what a camera looks along
    return std::vector<double>{std::cos(yaw * deg) * std::cos(down * deg),
                               std::sin(yaw * deg) * std::cos(down * deg), -std::sin(down * deg)};
  };
  const auto with_axis = [](std::vector<double> at, const std::vector<double>& looks) {
    at.insert(at.end(), looks.begin(), looks.end());
    return at;
  };
  expect(front.front(), with_axis({0.2, 0, 2}, axis(0, 30)));
  expect(left.front(), with_axis({0, 0.3, 1.9}, axis(90, 50)));
  const double c = std::cos(40 * deg), s = std::sin(40 * deg);
  expect(front.back(), with_axis({1 + 0.2 * c, 0.2 * s, 2}, axis(40, 30)));
  expect(left.back(), with_axis({1 - 0.3 * s, 0.3 * c, 1.9}, axis(130, 50)));
}

TEST_F(Cameras, RawlogHasALabelForEach) {
  const std::string info = read_with("rawlog-edit --info -i " + file("mission.rawlog"));
  for (const char* label : {"front", "left", "ground_truth", "imu"})
    EXPECT_NE(info.find(label), std::string::npos) << label << " is not in\n" << info;
  // 13 and 9 scans, 17 poses, 101 readings.
  EXPECT_NE(info.find("number of objects         : 140"), std::string::npos) << info;
}

// The npm reader of MCAP files finds what rosbag finds in the bag.
TEST_F(Cameras, McapHoldsTheSame) {
  const auto listed = test::run_node("list_topics.mjs", file("mission.mcap"));
  ASSERT_EQ(listed.exit_code, 0) << listed.output;
  const Json mcap = Json::parse(listed.output, nullptr, false), bag = read_bag();
  ASSERT_TRUE(mcap.is_object()) << listed.output;
  EXPECT_EQ(mcap["fixed"], bag["fixed"]);
  EXPECT_EQ(mcap["headers"], bag["headers"]);
  EXPECT_GE(mcap["headers"].size(), 11u);
}

TEST_F(Cameras, FoldersHoldOneEach) {
  for (const char* camera : {"front", "left"})
    for (const char* name : {"groundtruth.txt", "preview.png", "mission.simplemap", "tum/rgb.txt",
                             "frames/poses.csv", "frames/imu.csv"})
      EXPECT_TRUE(std::filesystem::exists(file(std::string("cameras/") + camera + "/" + name)))
          << camera << " " << name;
  EXPECT_FALSE(std::filesystem::exists(file("groundtruth.txt")));
  EXPECT_TRUE(std::filesystem::exists(file("cameras/left/frames/position/000008.exr")));
  EXPECT_FALSE(std::filesystem::exists(file("cameras/front/frames/position")));
  // EuRoC: both in one folder; T_BS of the second is its optical frame in the rig.
  const std::string yaml = read_file(file("euroc/mav0/cam1/sensor.yaml"));
  EXPECT_NE(yaml.find("rate_hz: 8\n"), std::string::npos) << yaml;
  const std::size_t data = yaml.find("data: [");
  std::vector<double> t;
  std::istringstream numbers(yaml.substr(data + 7));
  for (std::string word; std::getline(numbers, word, ',') && t.size() < 12;)
    t.push_back(std::stod(word));
  ASSERT_EQ(t.size(), 12u) << yaml;
  // Looking to the left and 50 degrees down, from (0, 0.3, -0.1); the picture's X axis is forward.
  const double down = 50 * std::acos(-1.0) / 180;
  const double wanted[] = {1, 0, 0, 0, 0, -std::sin(down), std::cos(down), 0.3,
                           0, -std::cos(down), -std::sin(down), -0.1};
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(t[i], wanted[i], 1e-12) << i;
}

TEST_F(Cameras, VerifyFindsTheSame) {
  const Outcome verify = run_rubble("verify " + (*folder_ / "out"));
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
}

// One camera and one unit, in either form, are the same sensors: the same path, the same bits of every sample.
TEST(CamerasShortForm, GivesTheSamplesOfListsOfOne) {
  const ScratchFolder folder;
  const std::string camera = "width = 64, height = 48, channels = { \"position\" }";
  // Without noise, whose seed is of the name.
  const std::string beside = "depth_sensor = { type = \"ideal\" }, "
                             "event_camera = { on = true, threshold_noise = 0, background_hz = 0 }";
  const std::string unit = "rate_hz = 50, position = { 0.1, 0, 0 }, gyroscope_noise = 0, gyroscope_walk = 0, "
                           "accelerometer_noise = 0, accelerometer_walk = 0";
  const std::string rest =
      "pile = { layers = 0 }, light = { elevation_deg = 20 }, trajectory = { rate_hz = 8, waypoints = { "
      "{ t = 0, position = { 0, 0, 2 }, rpy_deg = { 0, 30, 0 } }, { t = 0.5, position = { 0.5, 0, 2 }, rpy_deg = { 0, 30, 9 } }, "
      "{ t = 1, position = { 0.5, 0.5, 2 }, rpy_deg = { 0, 30, 0 } } } }, outputs = { frames = true } }";
  write_file(folder / "one.lua", "return rubble.mission { camera = { " + camera + " }, " + beside + ", imu = { on = true, " + unit +
                                     " }, " + rest);
  write_file(folder / "lists.lua", "return rubble.mission { cameras = { camera = { " + camera + ", " + beside +
                                       " } }, imus = { imu = { " + unit + " } }, " + rest);
  for (const char* name : {"one", "lists"}) {
    const Outcome run = run_rubble("run " + (folder / (std::string(name) + ".lua")) +
                                   " --quiet --out " + (folder / name));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const Json one = read_manifest(folder / "one"), lists = read_manifest(folder / "lists");
  EXPECT_EQ(one["frame_hashes"]["channels"], (Json{"pose", "rgb", "depth", "measured_depth", "position", "events", "imu"}));
  EXPECT_EQ(lists["frame_hashes"]["channels"], (Json{"camera/pose", "camera/rgb", "camera/depth", "camera/measured_depth",
                                                     "camera/position", "camera/events", "imu"}));
  EXPECT_EQ(one["frame_hashes"]["xxh64"].size(), 9u);
  EXPECT_EQ(one["frame_hashes"]["xxh64"], lists["frame_hashes"]["xxh64"]);
  for (const char* file : {"frames/rgb/000000.png", "frames/depth/000000.exr", "frames/poses.csv", "groundtruth.txt"}) {
    const std::string text = read_file(folder / (std::string("one/") + file));
    EXPECT_FALSE(text.empty());
    EXPECT_TRUE(text == read_file(folder / (std::string("lists/cameras/camera/") + file))) << file;
  }
  EXPECT_TRUE(read_file(folder / "one/flight.json") == read_file(folder / "lists/flight.json")) << "smoothed likewise";
}

// The mission that shows it, with a fisheye beside a pinhole, and what is in its bag by rosbag.
TEST(CamerasScript, RunsAsDocumented) {
  const ScratchFolder folder;
  const Outcome run = run_rubble("run scripts/two_cameras.lua --quiet --out " + (folder / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string command = "/usr/bin/python3 /usr/bin/rosbag info -y " +
                              (folder / "out/mission.bag") + " >" + (folder / "info") + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(folder / "info");
  const std::string info = read_file(folder / "info");
  for (const char* topic : {"/front/rgb/image_raw", "/side/left/rgb/image_raw",
                            "/side/left/ground_truth/instance/image", "/ground_truth/legend", "/imu"})
    EXPECT_NE(info.find(std::string(topic) + "\n"), std::string::npos) << topic << "\n" << info;
  for (const char* name : {"cameras/front/preview.png", "cameras/left/preview.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / (std::string("out/") + name))) << name;
}

// Of TUM's lines the stamps, and the rest of each.
std::vector<std::pair<double, std::string>> read_poses(const std::string& path) {
  std::vector<std::pair<double, std::string>> poses;
  std::istringstream text(read_file(path));
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t end = line.find(' ');
    poses.emplace_back(std::stod(line.substr(0, end)), line.substr(end));
  }
  return poses;
}

// Each camera stands on its mount while the pile settles, at its own rate, and then flies; its frames
// are numbered without a gap. The inertial unit measures all the time.
TEST(CamerasSettling, AllCamerasOfTheRigWatch) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", R"(return rubble.mission { seed = 2,
    pile = { layers = 1, pieces_per_layer = 6 },
    cameras = { front = { width = 48, height = 32, rate_hz = 10 },
                left = { width = 32, height = 32, position = { 0, 0.5, 0 }, rpy_deg = { 0, 0, 90 } } },
    record_settling = { to = 1, rate_hz = 5, position = { -6, 0, 2 }, look_at = { 0, 0, 1 } },
    imu = { on = true, rate_hz = 50 },
    trajectory = { rate_hz = 2, waypoints = { { t = 0, position = { -5, -4, 3 }, look_at = { 0, 0, 1 } },
                                              { t = 1, position = { 5, -4, 3 }, look_at = { 0, 0, 1 } } } },
    outputs = { frames = true, euroc = true, depth = "32FC1" } })");
  const Outcome run = run_rubble("run " + (folder / "m.lua") + " --quiet --out " + (folder / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto expect = [&](const std::string& name, std::size_t watching, std::size_t flying) {
    const auto poses = read_poses(folder / ("out/cameras/" + name + "/groundtruth.txt"));
    ASSERT_EQ(poses.size(), watching + flying) << name;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      EXPECT_GT(poses[i].first, poses[i - 1].first) << name << " " << i;
      EXPECT_EQ(poses[i].second == poses[i - 1].second, i < watching) << name << " " << i;
    }
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder / ("out/cameras/" + name + "/frames/rgb")))
      files.insert(entry.path().stem().string());
    ASSERT_EQ(files.size(), watching + flying) << name;
    EXPECT_EQ(std::stoul(*files.begin()), 0u) << name;
    EXPECT_EQ(std::stoul(*files.rbegin()), watching + flying - 1) << name;
  };
  expect("front", 11, 11);
  expect("left", 6, 3);
  std::istringstream readings(read_file(folder / "out/euroc/mav0/imu0/data.csv"));
  std::vector<std::int64_t> stamps;
  for (std::string line; std::getline(readings, line);)
    if (line[0] != '#') stamps.push_back(std::stoll(line));
  ASSERT_GT(stamps.size(), 150u);
  for (std::size_t i = 1; i < stamps.size(); ++i) EXPECT_NEAR(double(stamps[i] - stamps[i - 1]), 2e7, 2) << i;
}

TEST(CamerasInput, MistakesAreNamed) {
  const ScratchFolder folder;
  const auto errors_of = [&](const std::string& keys) {
    write_file(folder / "m.lua", "return rubble.mission {\n" + keys + "\n}");
    return run_rubble("check " + (folder / "m.lua")).err;
  };
  const auto expect = [&](const std::string& keys, const std::string& part) {
    const std::string errors = errors_of(keys);
    EXPECT_NE(errors.find(part), std::string::npos) << part << " is not in\n" << errors;
  };
  expect("cameras = { front = { widht = 64 } }", "cameras.front.widht: unknown key `widht` (did you mean `width`?)");
  expect("cameras = { Front = {} }", "cameras.Front: not a name of a camera");
  expect("cameras = { front = { width = 5 } }", "cameras.front.width: out of range");
  expect("cameras = { front = {} },\ncamera = { width = 64 }", "camera.width: contradicts cameras");
  expect("cameras = { {} }", "cameras: wrong type: expected tables by name { front = { ... } }");
  expect("cameras = { a = { topic = \"/x\" }, b = { topic = \"/x\" } }", "cameras.b.topic: the name is taken");
  expect("cameras = { a = { frame_id = \"/x\" } }", "cameras.a.frame_id: not a name of a frame");
  expect("cameras = { a = { channels = { \"flows\" } } }",
         "cameras.a.channels[1]: unknown channel `flows` (did you mean `flow`?)");
  expect("cameras = { a = { lens = { k1 = 0.1 } } }", "cameras.a.lens.model: a pinhole has no distortion");
}

TEST(CamerasInput, OverridesReachATableByName) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", "return rubble.mission { cameras = { front = {}, left = {} } }");
  const Outcome set = run_rubble("check " + (folder / "m.lua") +
                                 " --set cameras.left.width=320 --set cameras.left.position.y=0.5");
  ASSERT_EQ(set.exit_code, 0) << set.err;
  const Json json = Json::parse(set.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << set.out;
  EXPECT_EQ(json["cameras"]["left"]["width"], 320);
  EXPECT_EQ(json["cameras"]["front"]["width"], 1024);
  EXPECT_EQ(json["cameras"]["left"]["position"][1], 0.5);
  const Outcome wrong = run_rubble("check " + (folder / "m.lua") + " --set cameras.right.width=320");
  EXPECT_EQ(wrong.exit_code, 1);
}

}  // namespace cameras_test
}  // namespace rubble::testing
