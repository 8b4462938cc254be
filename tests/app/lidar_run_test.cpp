// LiDARs in missions, by readers that are not ours: rosbag, PCL's converter, MRPT's tools, the npm reader of
// MCAP files; a scan that the true motion straightens lies on pile.stl.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "kernel/queries/queries.h"
#include "tests/app/program.h"
#include "tests/app/tiny_run.h"
#include "tests/io/support.h"

namespace rubble::testing {
namespace lidar_run_test {

using Json = nlohmann::json;

// A rig that moves and turns about a few pieces; sensors without noise.
const char* const kMission = R"(
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 12, spawn_position = { 0, 0, 1.5 }, spawn_bounds = { 2.5, 2.5, 2 } },
  camera = { width = 64, height = 48 },
  lidars = {
    top = { model = "vlp16", noise = false, range_step = 0, divergence_mrad = 0, range_at_10_percent = 500,
            position = { 0, 0, 0.2 }, rpy_deg = { 0, 15, 0 } },
    front = { model = "mid360", frame_id = "eye" },
    low = { model = "utm30lx", position = { 0.1, 0, -0.1 } },
  },
  trajectory = { rate_hz = 4, waypoints = {
    { t = 0, position = { -3, -1, 0.9 }, rpy_deg = { 0, 10, 0 } },
    { t = 1, position = { -2.2, 0.3, 1.1 }, rpy_deg = { 0, 10, 70 } } } },
  outputs = { mcap = true, pcd = true, kitti = true },
})";

class LidarRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    write_file(*folder_ / "m.lua", kMission);
    outcome_ = run_rubble("run " + (*folder_ / "m.lua") + " --quiet --threads 2 --out " + (*folder_ / "out"));
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err; }

  static std::string file(const std::string& name) { return *folder_ / ("out/" + name); }

  static ScratchFolder* folder_;
  static Outcome outcome_;
};

// Empty where there is no such file.
std::string read_file_if_there(const std::string& path) {
  return std::filesystem::exists(path) ? read_file(path) : "";
}

ScratchFolder* LidarRun::folder_ = nullptr;
Outcome LidarRun::outcome_;

TEST_F(LidarRun, RosbagPclAndMcapReadTheSameClouds) {
  const auto bag = test::run_command("/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/read_lidar.py' " +
                                     file("") + " " + folder_->path().string());
  ASSERT_EQ(bag.exit_code, 0) << bag.output;
  const auto mcap = test::run_node("read_clouds.mjs", file("mission.mcap"));
  ASSERT_EQ(mcap.exit_code, 0) << mcap.output;
  const Json in_bag = Json::parse(bag.output, nullptr, false), in_mcap = Json::parse(mcap.output, nullptr, false);
  ASSERT_TRUE(in_bag.is_object()) << bag.output;
  EXPECT_EQ(in_bag, in_mcap);
  // Scans begin at every tenth of a second and at every fortieth, by whole scans up to the last frame's stamp.
  ASSERT_EQ(in_bag["/top/points"].size(), 10u);
  ASSERT_EQ(in_bag["/front/points"].size(), 10u);
  ASSERT_EQ(in_bag["/scan"].size(), 40u);
  EXPECT_EQ(in_bag["/front/points"][0]["frame"], "eye");
  EXPECT_EQ(in_bag["/top/points"][0]["frame"], "top_link");
  EXPECT_EQ(in_bag["/scan"][0]["size"], 1081);
  EXPECT_NEAR(in_bag["/scan"][0]["angles"][0].get<double>(), -0.75 * std::acos(-1.0), 1e-6);
  EXPECT_NEAR(in_bag["/scan"][0]["angles"][1].get<double>(), 0.75 * std::acos(-1.0), 1e-6);
  EXPECT_EQ(in_bag["/top/points"][0]["fields"],
            Json::parse(R"([["x",0,7,1],["y",4,7,1],["z",8,7,1],["intensity",12,7,1],["ring",16,4,1],["time",18,7,1]])"));
  EXPECT_GT(in_bag["/top/points"][0]["size"][1].get<int>(), 10000);
}

TEST_F(LidarRun, MrptListsTheirObservations) {
  const auto info = test::run_command("rawlog-edit --info -i " + file("mission.rawlog"));
  ASSERT_EQ(info.exit_code, 0) << info.output;
  for (const char* label : {"front", "low", "top"})
    EXPECT_NE(info.output.find(label), std::string::npos) << label << " is not in\n" << info.output;
  // 5 frames of two observations, 10 + 10 + 40 scans.
  EXPECT_NE(info.output.find("number of objects         : 70"), std::string::npos) << info.output;
}

TriangleMesh read_stl(const std::string& path) {
  const std::string bytes = read_file(path);
  TriangleMesh mesh;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) {
      Vec3f p;
      std::memcpy(&p, bytes.data() + 84 + 50 * std::size_t(t) + 12 * std::size_t(k + 1), sizeof p);
      mesh.positions.push_back(p);
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

struct PcdPoint {
  Vec3 place;
  double time = 0;
};

std::vector<PcdPoint> read_pcd(const std::string& path) {
  const std::string bytes = read_file(path);
  std::vector<PcdPoint> points;
  for (std::size_t at = bytes.find("DATA binary\n") + 12; at + 22 <= bytes.size(); at += 22) {
    float f[3], time;
    std::memcpy(f, bytes.data() + at, sizeof f);
    std::memcpy(&time, bytes.data() + at + 18, sizeof time);
    points.push_back({{double(f[0]), double(f[1]), double(f[2])}, double(time)});
  }
  return points;
}

struct MotionLine {
  double stamp;
  Pose world_from_lidar;
};

std::vector<MotionLine> read_motion(const std::string& path) {
  std::istringstream in(read_file(path));
  std::vector<MotionLine> lines;
  MotionLine m;
  Quat& q = m.world_from_lidar.rotation;
  Vec3& t = m.world_from_lidar.translation;
  while (in >> m.stamp >> t.x >> t.y >> t.z >> q.x >> q.y >> q.z >> q.w) lines.push_back(m);
  return lines;
}

// A point where it was seen from, by the two lines of motion.txt around its time.
Vec3 straighten(const std::vector<MotionLine>& motion, double stamp, const Vec3& p) {
  const auto after = std::upper_bound(motion.begin() + 1, motion.end() - 1, stamp,
                                      [](double s, const MotionLine& m) { return s < m.stamp; });
  const MotionLine &a = after[-1], &b = *after;
  const double share = (stamp - a.stamp) / (b.stamp - a.stamp);
  return (a.world_from_lidar * p) * (1 - share) + (b.world_from_lidar * p) * share;
}

TEST_F(LidarRun, AScanStraightenedByTheTrueMotionLiesOnThePile) {
  const TriangleMesh pile_mesh = read_stl(file("pile.stl"));
  ASSERT_GT(pile_mesh.triangles.size(), 100u);
  PileState pile;
  pile.types = {"pile"};
  pile.pieces.resize(1);
  const PileQueries queries(pile, {&pile_mesh});
  const std::vector<MotionLine> motion = read_motion(file("pcd/top/motion.txt"));
  std::istringstream stamps(read_file(file("pcd/top/stamps.txt")));
  double worst = 0, bent = 0;
  int on_pile = 0;
  std::string name;
  for (double stamp; stamps >> stamp >> name;) {
    const std::vector<PcdPoint> points = read_pcd(file("pcd/top/" + name));
    for (std::size_t i = 0; i < points.size(); i += 7) {
      const Vec3& seen = points[i].place;
      const Vec3 world = straighten(motion, stamp + points[i].time, seen);
      const auto closest = queries.find_closest(world, 1e9);
      worst = std::max(worst, closest->distance);
      on_pile += closest->piece == 0;
      bent = std::max(bent, queries.find_closest(straighten(motion, stamp, seen), 1e9)->distance);
    }
  }
  EXPECT_LT(worst, 1e-3) << "unit: m";
  EXPECT_GT(on_pile, 300);
  EXPECT_GT(bent, 0.03) << "the rig hardly moved while it scanned";
}

TEST_F(LidarRun, VerifyFindsTheSameAndScansAreAmongTheHashes) {
  const Json manifest = Json::parse(read_file(file("manifest.json")), nullptr, false);
  EXPECT_NE(manifest.dump().find("top/points"), std::string::npos);
  const Outcome verify = run_rubble("verify --threads 1 " + (*folder_ / "out"));
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
}

TEST_F(LidarRun, TheManifestAloneMakesTheSameScans) {
  const Outcome remake = run_rubble("remake --quiet --threads 1 " + file("manifest.json") + " --out " + (*folder_ / "again"));
  ASSERT_EQ(remake.exit_code, 0) << remake.out << remake.err;
  EXPECT_EQ(reproducible(*folder_ / "again"), reproducible(*folder_ / "out"));
  for (const char* name : {"mission.bag", "mission.mcap", "mission.rawlog", "pcd/top/000010.pcd", "kitti/front/poses.txt"})
    EXPECT_EQ(read_file(*folder_ / "again/" + name), read_file(file(name))) << name;
}

// Killed as soon as some frames are recorded, and scans between them: at three moments one after the other.
TEST_F(LidarRun, AfterKillsAmongItsFramesItGoesOnToTheSameBytes) {
  const std::string killed = *folder_ / "killed";
  int kills = 0;
  for (const int frames : {1, 2, 4}) {
    const auto recorded = [&] {
      std::istringstream lines(read_file_if_there(killed + "/unfinished/frames.txt"));
      int count = 0;
      for (std::string line; std::getline(lines, line);) ++count;
      return count > frames;
    };
    const bool begun = std::filesystem::exists(killed + "/unfinished/run.json");
    if (begun || kills == 0) {
      const std::string command = begun ? "resume " + killed : "run " + (*folder_ / "m.lua") + " --out " + killed;
      kills += run_rubble_and_signal(command + " --quiet --threads 2", recorded, SIGKILL).exit_code == 128 + SIGKILL;
    }
  }
  EXPECT_GT(kills, 0) << "it was always quicker";
  if (std::filesystem::exists(killed + "/unfinished")) {
    const Outcome last = run_rubble("resume --quiet " + killed);
    ASSERT_EQ(last.exit_code, 0) << last.err;
  }
  EXPECT_EQ(reproducible(killed), reproducible(*folder_ / "out"));
  for (const auto& [name, hash] : read_outputs(file("")))
    EXPECT_EQ(read_file(killed + "/" + name), read_file(file(name))) << name;
}

TEST_F(LidarRun, InfoReadsEveryFile) {
  const Outcome info = run_rubble("info " + (*folder_ / "out"));
  EXPECT_EQ(info.exit_code, 0) << info.out << info.err;
}

// A rover drives away from a sensor that stands; the pose of its base at each time is in robots/rover.txt.
TEST(LidarRobots, AreSeenWhereTheyAreAtTheTimeOfTheRay) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", R"(
return rubble.mission {
  pile = { layers = 0 },
  camera = { width = 64, height = 48 },
  lidars = { top = { model = "os0", columns = 1024, noise = false, divergence_mrad = 0, range_step = 0 } },
  robots = { rubble.robot.rover { name = "rover", position = { 1, 0, 0.001 }, drive = { { t = 0, linear = 1 } } } },
  robot_run = { duration = 1.5 },
  trajectory = { rate_hz = 5, waypoints = { { t = 0, position = { 0, 0, 0.4 } }, { t = 1, position = { 0, 0, 0.4 } } } },
  outputs = { pcd = true },
})");
  const Outcome run = run_rubble("run " + (folder / "m.lua") + " --quiet --out " + (folder / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(read_file(folder / "out/robots/rover.txt"));
  std::vector<std::pair<double, double>> base;  // stamp, x
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    double stamp, x;
    if (in >> stamp >> x) base.emplace_back(stamp, x);
  }
  ASSERT_GT(base.size(), 20u);
  const auto base_at = [&](double stamp) {
    std::size_t i = 1;
    while (i + 1 < base.size() && base[i].first < stamp) ++i;
    const auto &a = base[i - 1], &b = base[i];
    return a.second + (b.second - a.second) * (stamp - a.first) / (b.first - a.first);
  };
  // Its rear in the frame of its base, by the middle of what is seen straight ahead in each scan.
  std::vector<double> rear;
  for (int scan = 1; scan < 10; ++scan) {
    double nearest = 1e9, time = 0;
    for (const PcdPoint& p : read_pcd(folder / ("out/pcd/top/00000" + std::to_string(scan) + ".pcd")))
      if (p.place.z > -0.35 && p.place.x > 0 && std::fabs(p.place.y) < 0.3 && p.place.x < nearest)
        nearest = p.place.x, time = p.time;
    ASSERT_LT(nearest, 3) << scan;
    rear.push_back(nearest - base_at(1 + 0.1 * scan + time));
  }
  const auto [least, most] = std::minmax_element(rear.begin(), rear.end());
  EXPECT_LT(*most - *least, 0.02) << "unit: m";  // wheels turn, and rays fall elsewhere on them
  EXPECT_LT(*most, -0.1);
  EXPECT_GT(base_at(1.9) - base_at(1.1), 0.3) << "it hardly moved";
}

TEST(LidarInput, MistakesAreNamed) {
  const ScratchFolder folder;
  const auto expect = [&](const std::string& keys, const std::string& part) {
    write_file(folder / "m.lua", "return rubble.mission {\n" + keys + "\n}");
    const std::string errors = run_rubble("check " + (folder / "m.lua")).err;
    EXPECT_NE(errors.find(part), std::string::npos) << part << " is not in\n" << errors;
  };
  expect("lidars = { top = { model = \"vlp61\" } }", "m.lua:2: lidars.top.model: ");
  expect("lidars = { top = { rate = 5 } }", "lidars.top.rate: unknown key `rate` (did you mean `rate_hz`?)");
  expect("lidars = { top = { channels = 64 } }", "lidars.top.channels: this model has a fixed number");
  expect("lidars = { top = { model = \"os1\", columns = 600 } }", "lidars.top.columns: the model has no such version");
  expect("lidars = { top = { min_range = 50, max_range = 20 } }", "lidars.top.max_range: the range is empty");
  expect("lidars = { Top = {} }", "lidars.Top: not a name of a sensor");
  expect("imu = true, lidars = { a = { topic = \"/imu\" } }", "lidars.a.topic: the name is taken");
  expect("outputs = { pcd = true }", "outputs.pcd: there is nothing to write");
}

}  // namespace lidar_run_test
}  // namespace rubble::testing
