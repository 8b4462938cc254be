// Robots of a mission, through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "app/measures/metrics.h"
#include "app/pipeline/stages.h"
#include "app/provenance/manifest.h"
#include "app/provenance/run_folder.h"
#include "kernel/base/math.h"
#include "scripting/scenario/scenario.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace robots_test {

constexpr const char* kQuick =
    " --set camera.width=48 --set camera.height=48 --set camera.quality=draft --set trajectory.rate_hz=0.5 --set robot_run.duration=2"
    " --set outputs.bag=false --set outputs.rawlog=false --set outputs.simplemap=false --out ";

using Rows = std::vector<std::vector<double>>;

// Numbers of a file, line by line; stamps as seconds. Lines that begin with anything else are left out.
Rows read_rows(const std::string& path) {
  Rows rows;
  std::istringstream in(read_file(path));
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] < '0' || line[0] > '9') continue;
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream numbers(line);
    std::vector<double>& row = rows.emplace_back();
    for (double value = 0; numbers >> value;) row.push_back(value);
  }
  return rows;
}

// A mission with robots, on one thread and on two, into the folders 1 and 2 of `scratch`. Gives what the second run said.
std::string expect_same_tracks(const ScratchFolder& scratch, const std::string& mission, const std::string& more = "") {
  std::string tracks[2], said;
  for (int threads = 1; threads <= 2; ++threads) {
    const std::string out = scratch / std::to_string(threads);
    const Outcome run = run_rubble("run " + mission + " --threads " + std::to_string(threads) + kQuick + out + more);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    tracks[threads - 1] = read_file(out + "/robots/track.bin");
    said = run.err;
  }
  EXPECT_FALSE(tracks[0].empty());
  EXPECT_TRUE(tracks[0] == tracks[1]);
  return said;
}

TEST(Robots, RunsHaveTheSameBitsOnAnyNumberOfThreadsAndAreVerified) {
  const ScratchFolder scratch;
  expect_same_tracks(scratch, "scripts/robots/controller.lua");
  const Outcome verified = run_rubble("verify " + (scratch / "1"));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

// The mission whose cost docs/development/robots.md states.
TEST(Robots, ASnakeAmongManyContactsHasTheSameBitsOnAnyNumberOfThreads) {
  const std::string told = expect_same_tracks(ScratchFolder(), "bench/snake_bed.lua"), contacts = "contacts: ";
  const std::size_t at = told.find(contacts);
  ASSERT_NE(at, std::string::npos) << told;
  EXPECT_GT(std::stod(told.substr(at + contacts.size())), 20);
}

Vec3 vector_in(const std::vector<double>& row, std::size_t at) { return {row[at], row[at + 1], row[at + 2]}; }

TEST(Robots, AVineGrowsWithTheSameBitsOnAnyNumberOfThreads) {
  const ScratchFolder scratch;
  expect_same_tracks(scratch, "scripts/robots/vine.lua", " --set robot_run.duration=4");
  // Stamp, then position, speed and force of growth: its length rises by the speed of growth.
  const Rows joints = read_rows(scratch / "1/robots/vine_joints.csv");
  ASSERT_EQ(joints.size(), 241u);  // the last at the end
  EXPECT_NEAR(joints[180][1] - joints[60][1], 2 * 0.25, 0.02);
  // The pose is that of the tip: it is where the length says.
  const Rows poses = read_rows(scratch / "1/robots/vine.txt");
  EXPECT_NEAR(poses.back()[1], -5.2 + joints.back()[1], 0.05);
  EXPECT_NE(read_file(scratch / "1/robots/vine.urdf").find("growth"), std::string::npos);
}

// scripts/robots/sensors.lua, with an inertial unit without noise.
class CarriedSensors : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    outcome_ = run_rubble(
        "run scripts/robots/sensors.lua --quiet --set camera.width=48 --set camera.height=48 --set camera.quality=draft"
        " --set imu.gyroscope_noise=0 --set imu.gyroscope_walk=0 --set imu.accelerometer_noise=0"
        " --set imu.accelerometer_walk=0 --set outputs.tum=true --out " + file(""));
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
ScratchFolder* CarriedSensors::folder_ = nullptr;
Outcome CarriedSensors::outcome_;

// A metric that suites do not know cannot have limits: robot_slip was one.
TEST_F(CarriedSensors, SuitesKnowEveryMetric) {
  const Manifest manifest = manifest_from_json(read_file(file("manifest.json")), "manifest.json");
  EXPECT_EQ(manifest.metrics.count("robot_slip"), 1u);
  std::set<std::string> known;
  for (const auto& [name, meaning] : metric_names()) known.insert(name);
  for (const auto& [name, value] : manifest.metrics) EXPECT_EQ(known.count(name), 1u) << name;
}

// The body of the camera is where the mount on the link is: 15 degrees nose down.
TEST_F(CarriedSensors, TheCameraIsOnItsLink) {
  std::map<long, Pose> base;
  for (const auto& row : read_rows(file("robots/tank.txt")))
    base[std::lround(row[0] * 1000)] = {{row[7], row[4], row[5], row[6]}, vector_in(row, 1)};
  const double half = 7.5 * std::acos(-1) / 180;
  const Pose mount{{std::cos(half), 0, std::sin(half), 0}, {0.3, 0, 0.3}};
  int compared = 0;
  double way = 0;
  for (const auto& row : read_rows(file("euroc/mav0/state_groundtruth_estimate0/data.csv"))) {
    const auto at = base.find(std::lround(row[0] * 1e-6));
    if (at == base.end()) continue;
    const Pose expected = at->second * mount;
    EXPECT_LT(distance(expected.translation, vector_in(row, 1)), 1e-6) << row[0];
    EXPECT_NEAR(std::abs(expected.rotation.w * row[4] + expected.rotation.x * row[5] +
                         expected.rotation.y * row[6] + expected.rotation.z * row[7]), 1, 1e-9);
    way = distance(expected.translation, {-1.5, 0, 0.3});
    ++compared;
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(way, 0.8) << "it was to drive";
}

// What an inertial unit without noise felt, integrated from the true start, is the way that the simulated
// link went, over bricks and with their impacts.
TEST_F(CarriedSensors, TheInertialUnitIntegratedFollowsTheTruePose) {
  const Rows state = read_rows(file("euroc/mav0/state_groundtruth_estimate0/data.csv"));
  const Rows imu = read_rows(file("euroc/mav0/imu0/data.csv"));
  ASSERT_GT(state.size(), 50u);
  Pose at{{state[0][4], state[0][5], state[0][6], state[0][7]}, vector_in(state[0], 1)};
  Vec3 velocity = vector_in(state[0], 8);
  std::size_t next = 0, compared = 0;
  double worst = 0, turned = 0;
  for (std::size_t i = 0; i + 1 < imu.size(); ++i) {
    while (next < state.size() && state[next][0] < imu[i][0] - 1000) ++next;
    if (next < state.size() && std::abs(state[next][0] - imu[i][0]) < 1000) {
      worst = std::max(worst, distance(at.translation, vector_in(state[next], 1)));
      ++compared;
    }
    const double h = (imu[i + 1][0] - imu[i][0]) * 1e-9;
    const Vec3 rate = (vector_in(imu[i], 1) + vector_in(imu[i + 1], 1)) * (0.5 * h);
    const double angle = norm(rate), scale = angle > 1e-12 ? std::sin(0.5 * angle) / angle : 0.5;
    const Quat turn{std::cos(0.5 * angle), rate.x * scale, rate.y * scale, rate.z * scale};
    const Quat after = normalized(at.rotation * turn);
    const Vec3 force =
        (at.rotation.rotate(vector_in(imu[i], 4)) + after.rotate(vector_in(imu[i + 1], 4))) * 0.5;
    const Vec3 a = force - Vec3{0, 0, 9.81};
    at.translation += velocity * h + a * (0.5 * h * h);
    velocity += a * h;
    at.rotation = after;
    turned += angle;
  }
  EXPECT_GT(compared, 50u);
  EXPECT_GT(turned, 1) << "the ride was to be rough";
  EXPECT_LT(worst, 0.05) << "unit: m, after 6 s";
}

TEST_F(CarriedSensors, OdometryIsKeptBesideTheTruth) {
  const Rows rows = read_rows(file("robots/tank_odometry.csv"));
  ASSERT_EQ(rows.size(), 361u);  // 6 s at 60 Hz
  EXPECT_NEAR(rows[60][4], 0.4, 1e-9) << "by the belts";
  EXPECT_LT(rows[60][6], 0.41) << "the truth";
  EXPECT_GT(rows[60][6], 0.2);
  EXPECT_TRUE(std::filesystem::is_regular_file(file("robots/tank.urdf")));
  // What is seen is the looks; what collides is a box of twelve triangles.
  const std::string urdf = read_file(file("robots/tank.urdf"));
  EXPECT_NE(urdf.find("<visual><geometry><mesh filename=\"tank_meshes/left_track.stl\""), std::string::npos);
  EXPECT_NE(urdf.find("<collision><geometry><mesh filename=\"tank_meshes/left_track_part_0.obj\""), std::string::npos);
  const auto count_faces = [](const std::string& path) {
    const std::string text = read_file(path);
    std::size_t faces = 0;
    for (std::size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) ++faces;
    return faces;
  };
  EXPECT_EQ(count_faces(file("robots/tank_meshes/left_track_part_0.obj")), 12u);
  const std::size_t head = 84, triangle = 50;  // of a binary STL file; unit: byte
  EXPECT_GT(std::filesystem::file_size(file("robots/tank_meshes/left_track.stl")), head + 1000 * triangle);
}

TEST_F(CarriedSensors, TheRunIsVerified) {
  const Outcome verified = run_rubble("verify " + file(""));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

// scripts/robots/team.lua: a crawler, a snake and a rover, each with sensors of its own.
TEST(Robots, EachOfSeveralCarriesItsOwnSensors) {
  const ScratchFolder scratch;
  const std::string out = scratch / "out";
  std::string small;
  for (const char* camera : {"overview", "tank_front", "snake_head", "scout_front"})
    small += std::string(" --set cameras.") + camera + ".width=48 --set cameras." + camera + ".height=48 --set cameras." + camera +
             ".quality=draft";
  const Outcome run = run_rubble("run scripts/robots/team.lua --quiet --set robot_run.duration=2"
                                 " --set outputs.frames=true --out " + out + small);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const struct {
    const char *camera, *robot;
    Vec3 position;
    std::size_t frames;
  } riders[] = {{"tank_front", "tank", {0.32, 0, 0.3}, 11},
                {"snake_head", "snake", {0.05, 0, 0}, 11},
                {"scout_front", "scout", {0.22, 0, 0.25}, 5}};
  for (const auto& rider : riders) {
    std::map<long, Pose> base;
    for (const auto& row : read_rows(out + "/robots/" + rider.robot + ".txt"))
      base[std::lround(row[0] * 1000)] = {{row[7], row[4], row[5], row[6]}, vector_in(row, 1)};
    const Rows poses = read_rows(out + "/cameras/" + rider.camera + "/groundtruth.txt");
    EXPECT_EQ(poses.size(), rider.frames) << "each at its own rate, as long as it is driven";
    double way = 0;
    for (const auto& row : poses) {
      const auto at = base.find(std::lround(row[0] * 1000));
      ASSERT_NE(at, base.end()) << row[0];
      EXPECT_LT(distance(at->second * rider.position, vector_in(row, 1)), 1e-6) << rider.camera;
      way = distance(vector_in(poses[0], 1), vector_in(row, 1));
    }
    EXPECT_GT(way, 0.05) << rider.camera << " was to move";
  }
  // The inertial units beside two of them: 2 s at their own rates, and both feel their weight.
  const Rows tank = read_rows(out + "/cameras/tank_front/frames/imu.csv");
  const Rows snake = read_rows(out + "/cameras/snake_head/frames/imu.csv");
  EXPECT_EQ(tank.size(), 401U);
  EXPECT_EQ(snake.size(), 201U);
  for (const Rows* readings : {&tank, &snake}) {
    double felt = 0;
    for (const auto& row : *readings) felt += norm(vector_in(row, 4)) / double(readings->size());
    EXPECT_GT(felt, 9);
    EXPECT_LT(felt, 20);
  }
  EXPECT_FALSE(std::filesystem::exists(out + "/cameras/scout_front/frames/imu.csv")) << "it has none";
  const Outcome verified = run_rubble("verify " + out);
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

// The quickest run that drives robots: a frame of a few pixels.
std::string run_robots_only(const std::string& script, const std::string& out) {
  return "run scripts/robots/" + script + " --quiet --set camera.width=16 --set camera.height=16 --set camera.quality=draft"
         " --set trajectory.rate_hz=0.01 --set outputs.bag=false --set outputs.rawlog=false"
         " --set outputs.simplemap=false --set outputs.stl=false --set outputs.preview=false --out " + out;
}

TEST(Robots, AVineGrowsAlongAPathAndRetracts) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", R"(return rubble.mission { pile = { layers = 0 },
    robots = { rubble.robot.vine { name = "vine", position = { 0, 0, 0.051 }, length = 2,
      control = rubble.robot.grow_along { path = { { 0, 0, 0.05 }, { 0.6, 0, 0.05 }, { 1.2, 0.4, 0.05 } },
                                          speed = 0.3, back = true } } },
    robot_run = { duration = 11 }, camera = { width = 16, height = 16 }, trajectory = { rate_hz = 0.1 },
    outputs = { bag = false, rawlog = false, simplemap = false, stl = false, preview = false } })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --quiet --out " + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Rows tip = read_rows(scratch / "out/robots/vine.txt");
  double farthest = 0;
  for (const auto& row : tip) farthest = std::max(farthest, row[2]);
  EXPECT_GT(farthest, 0.3) << "it was to grow to its left";
  EXPECT_LT(distance(vector_in(tip.front(), 1), vector_in(tip.back(), 1)), 0.005);
}

// Missions over the pile of first_pile.lua, which settles once for all of them. Their robots are driven as a run does it, but
// no picture is taken: most of such a run is the light of 1,200 pieces.
class RobotsInTheFirstPile : public ::testing::Test {
 protected:
  // Of mission and pile.
  static std::string pile_of(const ResolvedMission& mission) {
    const auto json = nlohmann::json::parse(scenario_to_json(mission.scenario));
    return json["pile"].dump() + json["settle"].dump() + json["seed"].dump();
  }

  // Into the folder `out`.
  void drive(const std::string& script) {
    RunOptions options;
    options.quiet = true;
    RunContext context(options);
    RunRequest request;
    request.mission = RUBBLE_SOURCE_DIR "/scripts/robots/" + script;
    const ResolvedMission mission = resolve_mission(request, RunKind::run, context);
    static const std::string settled_as = pile_of(mission);
    static const SettledPile settled = settle_in_memory(mission, context, [] { return true; });
    ASSERT_EQ(pile_of(mission), settled_as) << "the missions have one pile";
    RunFolder folder = RunFolder::create(scratch_ / "out", false);
    folder.begin(describe_unfinished(mission));
    drive_robots(mission, settled, folder, context);
  }

  // The lean-to opens to -X at -4.6 m: how deep a robot gets, and where it is in the end.
  void expect_in_and_out(const std::string& robot, double depth) {
    drive("lean_to_" + robot + ".lua");
    const Rows poses = read_rows(scratch_ / ("out/robots/" + robot + ".txt"));
    ASSERT_GT(poses.size(), 100U);
    double deepest = -100;
    for (const auto& row : poses) deepest = std::max(deepest, row[1]);
    EXPECT_LT(poses.front()[1], -4.7) << "it was to start outside";
    EXPECT_GT(deepest, depth);
    EXPECT_LT(poses.back()[1], -4.7) << "it was to come out again";
  }

  ScratchFolder scratch_;
};

TEST_F(RobotsInTheFirstPile, ACrawlerGoesIntoTheLeanToAndOut) { expect_in_and_out("crawler", -1.7); }
TEST_F(RobotsInTheFirstPile, ARoverGoesIntoTheLeanToAndOut) { expect_in_and_out("rover", -2.6); }
TEST_F(RobotsInTheFirstPile, ASnakeRollsIntoTheLeanToAndOut) { expect_in_and_out("snake", -3.8); }
TEST_F(RobotsInTheFirstPile, AVineGrowsIntoTheLeanToAndOut) { expect_in_and_out("vine", -3.3); }

// The tip ends within the ball that `rubble voids` says gets there, and no deeper place is in any void.
TEST_F(RobotsInTheFirstPile, AVineGrowsToTheDeepestVoid) {
  drive("deepest_void.lua");
  if (HasFatalFailure()) return;
  const Outcome settled = run_rubble("settle scripts/robots/deepest_void.lua --quiet --out " + (scratch_ / "pile"));
  ASSERT_EQ(settled.exit_code, 0) << settled.err;
  const Outcome voids = run_rubble("voids " + (scratch_ / "pile") + " --radius 0.35 --voxel 0.05 --surfaces 0 --quiet");
  ASSERT_EQ(voids.exit_code, 0) << voids.err;
  const auto map = nlohmann::json::parse(read_file(scratch_ / "pile/voids/voids.json"));
  const auto& found = map["robots"][0]["voids"];
  const auto& at = found[0]["deepest"];
  const Vec3 deepest{at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
  const Vec3 tip = vector_in(read_rows(scratch_ / "out/robots/vine.txt").back(), 1);
  EXPECT_LT(distance(tip, deepest), 0.35);
  for (const auto& other : found) {
    if (other["entrances"].empty()) continue;  // nothing of this size gets in
    EXPECT_LE(other["depth"].get<double>(), found[0]["depth"].get<double>());
  }
}

// Bricks on a slope are held by a block; when a vine has pushed it away, they slide: by more than a piece was pushed.
TEST(Robots, ASlideFollowsWhereAVinePushesAwayWhatHoldsIt) {
  const ScratchFolder scratch;
  const Outcome run = run_rubble(run_robots_only("slide.lua", scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Manifest manifest = manifest_from_json(read_file(scratch / "out/manifest.json"), "manifest.json");
  EXPECT_GE(manifest.metrics.at("robot_pieces_moved"), 10);
  // Nothing moves before it is touched, and without a robot that pushes nothing ever does.
  const Outcome still = run_rubble(run_robots_only("slide.lua", scratch / "still") + " --set robot_run.duration=2");
  ASSERT_EQ(still.exit_code, 0) << still.err;
  EXPECT_EQ(manifest_from_json(read_file(scratch / "still/manifest.json"), "").metrics.at("robot_pieces_moved"), 0);
}

}  // namespace robots_test
}  // namespace rubble::testing
