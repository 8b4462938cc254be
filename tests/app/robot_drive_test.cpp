// A robot that is driven live, and the mission that is kept of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/control/robot_control.h"
#include "app/drive/robots/robot_drive.h"
#include "app/mission/scenario_lua.h"
#include "app/pipeline/stages.h"
#include "app/robots/robot_files.h"
#include "app/session/session.h"
#include "io/state/track_file.h"
#include "kernel/base/error.h"
#include "scripting/robots/rover.h"
#include "tests/app/program.h"
#include "tests/scripting/robot_figures.h"

namespace rubble::testing {
namespace robot_drive_test {

const char* const kRobots = R"(return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 12, spawn_bounds = { 0.8, 0.8, 0.6 }, mix = { { asset = "brick" } } },
  robots = {
    rubble.robot.crawler { name = "tank", position = { -1.3, 0, 0.001 } },
    rubble.robot.snake { name = "snake", position = { -1, 1.5, 0.03 }, drive = { { t = 0, gait = "rolling" } } },
    rubble.robot.vine { name = "vine", position = { -1, -1.5, 0.052 }, length = 1 },
  },
  camera = { width = 32, height = 24 }, trajectory = { rate_hz = 30 },
  outputs = { bag = false, rawlog = false, simplemap = false, stl = false, preview = false },
})";

// The mission, settled, and its robots.
struct Driven {
  explicit Driven(const ScratchFolder& scratch, const std::string& robot, const char* text = kRobots, bool sensed = false)
      : context(options(sensed)) {
    write_file(scratch / "m.lua", text);
    RunRequest request;
    request.mission = scratch / "m.lua";
    mission = resolve_mission(request, RunKind::run, context);
    pile = settle_in_memory(mission, context, [] { return true; }).state;
    drive = std::make_unique<RobotDrive>(mission, pile, robot, context);
  }
  static RunOptions options(bool sensed) {
    RunOptions options;
    options.quiet = true;
    options.live.ros1 = sensed;
    return options;
  }
  // Frames 1 to `frames`, at 30 Hz; the wish by the frame.
  void go(int frames, const std::function<TeleopCommand(int)>& wish) {
    for (int i = 1; i <= frames; ++i) drive->advance(wish(i), i / 30.0);
  }

  RunContext context;
  ResolvedMission mission;
  PileState pile;
  std::unique_ptr<RobotDrive> drive;
};

// What a run of the kept mission does, against what was driven.
void expect_same_bits(const ScratchFolder& scratch, Driven& driven, const std::string& in = "") {
  write_file(scratch / (in + "leg.lua"), scenario_to_lua(driven.drive->scenario(driven.mission.scenario), "kept"));
  save_track(driven.drive->finish(), scratch / "leg.track");
  const Outcome run = run_rubble("run " + (scratch / (in + "leg.lua")) + " --quiet --set trajectory.rate_hz=0.5 --out " +
                                 (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(read_file(scratch / "leg.track").empty());
  EXPECT_TRUE(read_file(scratch / "leg.track") == read_file(scratch / "out/robots/track.bin"));
}

TEST(RobotDrive, ACrawlerThatIsDrivenIntoBricksRunsAgainWithTheSameBits) {
  const ScratchFolder scratch;
  Driven driven(scratch, "tank");
  const Vec3 start = driven.drive->world_from_rig().translation;
  driven.go(75, [](int i) {
    TeleopCommand wish;
    wish.forward = i < 60 ? 1 : 0, wish.yaw = i > 30 ? 0.4 : 0, wish.pitch = i % 7 == 0 ? 1 : 0;
    wish.linear.x = i == 70 ? 0.123456789 : 0;
    return wish;
  });
  EXPECT_GT(driven.drive->world_from_rig().translation.x, start.x + 0.4) << "the camera goes with it";
  expect_same_bits(scratch, driven);
}

TEST(RobotDrive, ASnakeAndAVineToo) {
  for (const char* robot : {"snake", "vine"}) {
    const ScratchFolder scratch;
    Driven driven(scratch, robot);
    const Vec3 start = driven.drive->world_from_rig().translation;
    driven.go(60, [](int i) {
      TeleopCommand wish;
      wish.forward = i < 50 ? 1 : 0, wish.yaw = i > 40 ? 1 : 0;
      return wish;
    });
    EXPECT_GT(distance(driven.drive->world_from_rig().translation, start), 0.02) << robot;
    expect_same_bits(scratch, driven);
  }
}

// The kept mission lies elsewhere than the script whose file it needs.
TEST(RobotDrive, ARobotFromAFileTakesItsFileAlong) {
  const ScratchFolder scratch;
  write_robot_description(scratch.path().string(), "rover", make_rover());
  Driven driven(scratch, "", R"(return rubble.mission { pile = { layers = 0 },
    robots = { { urdf = "rover.urdf", name = "buggy", position = { 0, 0, 0.001 }, friction = 0.8,
      left_wheels = { "front_left_wheel_joint", "rear_left_wheel_joint" },
      right_wheels = { "front_right_wheel_joint", "rear_right_wheel_joint" }, wheel_radius = 0.098 } },
    camera = { width = 32, height = 32 }, outputs = { bag = false, rawlog = false, simplemap = false } })");
  driven.go(30, [](int) {
    TeleopCommand wish;
    wish.linear.x = 0.4, wish.angular.z = 0.3;
    return wish;
  });
  std::filesystem::create_directories(scratch / "elsewhere");
  expect_same_bits(scratch, driven, "elsewhere/");
}

// Named joints alone, while the belts go on; the mission that is kept says so.
TEST(RobotDrive, ATrajectoryMovesNamedJointsAndRunsAgainWithTheSameBits) {
  const ScratchFolder scratch;
  Driven driven(scratch, "tank");
  TeleopCommand wish;
  wish.linear.x = 0.3;
  driven.go(15, [&](int) { return wish; });
  driven.drive->follow({{"rear_right_flipper_joint", "front_left_flipper_joint"},
                        {{{0.1, 0.2}, {}, 0.4}, {{0.3, -0.3}, {0, 0}, 1}}});
  EXPECT_THROW(driven.drive->follow({{"tail"}, {{{1}, {}, 1}}}), InputError);
  for (int i = 16; i <= 60; ++i) driven.drive->advance(wish, i / 30.0);
  const Scenario kept = driven.drive->scenario(driven.mission.scenario);
  const RobotLeg& last = kept.robots[0].drive.back();
  EXPECT_EQ(last.joint_names, (std::vector<std::string>{"front_left_flipper_joint", "rear_right_flipper_joint"}));
  EXPECT_EQ(last.joints, (std::vector<double>{-0.3, 0.3}));
  EXPECT_EQ(last.linear, 0.3);
  expect_same_bits(scratch, driven);
  const std::string joints = read_file(scratch / "out/robots/tank_joints.csv");
  EXPECT_NE(joints.find("front_left_flipper_joint_position"), std::string::npos) << joints.substr(0, 400);
}

TEST(RobotDrive, AfterARestartItStandsWhereItBegan) {
  const ScratchFolder scratch;
  Driven driven(scratch, "");
  const Pose start = driven.drive->world_from_rig();
  driven.go(20, [](int) {
    TeleopCommand wish;
    wish.forward = 1;
    return wish;
  });
  EXPECT_GT(distance(driven.drive->world_from_rig().translation, start.translation), 0.05);
  driven.drive->restart();
  EXPECT_EQ(driven.drive->world_from_rig().translation, start.translation);
  EXPECT_EQ(driven.drive->scenario(driven.mission.scenario).robots[0].drive.size(), 1U);
}

// Fines on the ground and what stands about the pile belong to no piece: they stay where they are.
TEST(RobotDrive, SeesFinesAndSurroundingsStandStill) {
  const ScratchFolder scratch;
  Driven driven(scratch, "", R"(return rubble.mission { seed = 3,
    pile = { layers = 1, pieces_per_layer = 5, mix = { { asset = "brick" } } },
    fines = { amount = 200 }, surroundings = { type = "street", reach = 40 },
    robots = { rubble.robot.rover { position = { -4, 0, 0.001 } } } })");
  const Scene scene = driven.drive->build_scene(driven.mission.scenario);
  std::size_t standing = 0;
  for (const SceneInstance& instance : scene.instances) standing += instance.surrounds;
  EXPECT_GT(standing, 100u);
  for (const std::uint32_t i : scene.motion.moving) EXPECT_FALSE(scene.instances[i].surrounds);
  EXPECT_LT(scene.motion.reach.max.x, 30) << "a street does not go along";
  EXPECT_EQ(scene.motion.poses_at(0).size(), scene.motion.moving.size());
}

// What a sample holds that may differ, as bytes.
std::string bytes_of(const Sample& sample) {
  std::string bytes;
  const auto add = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(stamp_of(sample));
  if (const auto* reading = std::get_if<Reading>(&sample); reading && reading->scan)
    for (const ScanPoint& p : reading->scan->points) add(p.x), add(p.y), add(p.z), add(p.intensity), add(p.time), add(p.ring);
  if (const auto* reading = std::get_if<ImuSample>(&sample)) add(reading->angular_velocity), add(reading->linear_acceleration);
  if (const auto* robot = std::get_if<RobotSample>(&sample)) {
    add(robot->world_from_base);
    for (const RobotSample::Wrench& contact : robot->contacts) add(contact);
  }
  return bytes;
}

// Bricks that are pushed before its LiDAR, within a street: contacts and samples of the drive are those of a session of
// the mission that it leaves.
TEST(RobotDrive, SensesWhatTheKeptMissionSenses) {
  const ScratchFolder scratch;
  Driven driven(scratch, "tank", R"(return rubble.mission {
    seed = 3,
    pile = { layers = 1, pieces_per_layer = 6, spawn_bounds = { 0.5, 0.5, 0.4 }, mix = { { asset = "brick" } } },
    surroundings = { type = "street", reach = 40 },
    robots = { rubble.robot.crawler { name = "tank", position = { -1, 0, 0.001 } } },
    lidars = { top = { model = "utm30lx", ride = { robot = "tank" }, position = { 0.2, 0, 0.3 }, rpy_deg = { 0, 10, 0 } } },
    imu = { on = true, ride = { robot = "tank" } }, camera = { width = 32, height = 24 },
  })", true);
  std::vector<Sample> sensed;
  for (int i = 1; i <= 30; ++i) {
    TeleopCommand wish;
    wish.linear.x = 0.6, wish.angular.z = i > 15 ? 0.5 : 0;
    driven.drive->advance(wish, i / 30.0);
    for (Sample& sample : driven.drive->take_sensed()) sensed.push_back(std::move(sample));
  }
  ResolvedMission kept = driven.mission;
  kept.scenario = driven.drive->scenario(driven.mission.scenario);
  SessionOptions options;
  options.observed = true;
  Session session(kept, driven.pile, make_robots(kept, driven.context), driven.context, options);
  session.start();
  while (session.steps() < session.steps_of_mission()) session.step();
  const std::vector<Sample> again = session.observe();
  ASSERT_EQ(sensed.size(), again.size());
  std::array<int, 8> kinds{};
  for (const Sample& sample : sensed) ++kinds[sample.index()];
  EXPECT_GT(kinds[Sample(Reading()).index()], 30);
  EXPECT_GT(kinds[Sample(ImuSample()).index()], 150);
  const auto in_order = [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); };
  std::stable_sort(sensed.begin(), sensed.end(), in_order);
  for (std::size_t i = 0; i < sensed.size(); ++i) ASSERT_TRUE(bytes_of(sensed[i]) == bytes_of(again[i])) << i;
  const DrivenRobots end = session.finish();
  EXPECT_GT(end.pieces_moved, 0) << "a mission in which nothing moves shows nothing";
  EXPECT_EQ(end.moved.track.hash(), driven.drive->finish().hash());
}

// Then only robots are lit anew for every picture.
TEST(RobotDrive, SeesDebrisThatIsFixedStandStill) {
  const ScratchFolder scratch;
  Driven driven(scratch, "", kRobots);
  Scenario scenario = driven.mission.scenario;
  const Scene free = driven.drive->build_scene(scenario);
  scenario.robot_run.debris = DebrisMotion::fixed;
  const Scene fixed = driven.drive->build_scene(scenario);
  EXPECT_EQ(free.motion.moving.size() - fixed.motion.moving.size(), driven.pile.pieces.size());
  EXPECT_GT(fixed.motion.moving.size(), 20U) << "links move";
}

TEST(RobotDrive, MistakesAreNamed) {
  const ScratchFolder scratch;
  const auto mistake = [&](const std::string& robot, const char* text) {
    try {
      Driven driven(scratch, robot, text);
    } catch (const InputError& error) {
      return error.diagnostics()[0].text();
    }
    return std::string();
  };
  EXPECT_NE(mistake("tonk", kRobots).find("--robot: no robot has this name: expected one of tank, snake, vine"),
            std::string::npos);
  const char* const kWithFunction = R"(return rubble.mission { pile = { layers = 0 }, robots = {
    rubble.robot.rover { position = { 0, 0, 0.001 } },
    rubble.robot.rover { position = { 0, 2, 0.001 }, control = function() return {} end } } })";
  EXPECT_NE(mistake("", kWithFunction).find("robots[2].control: a controller function cannot run during a drive"), std::string::npos);
  const char* const kTail = R"(return rubble.mission { pile = { layers = 0 }, robots = {
    rubble.robot.rover { position = { 0, 0, 0.001 }, drive = {
      { t = 0, joints = { 1 }, joint_names = { "tail" } } } } } })";
  EXPECT_NE(mistake("", kTail).find("robots[1].drive[1].joint_names: the robot has no joint of this name with a motor"),
            std::string::npos) << mistake("", kTail);
  EXPECT_EQ(mistake("rover_2", kWithFunction), "") << "what is driven has no need of its function";
}

// The command after `last` from `time` on.
RobotLeg steer(const RobotItem& robot, const TeleopCommand& asked, const RobotLeg& last, double time, double seconds) {
  RobotLeg leg = last;
  leg.t = time;
  kind_of(robot).steer(asked, robot, last, seconds, leg);
  return leg;
}

// The waves of a snake go on from where they are when it is told to go faster, slower or to stop.
TEST(Teleop, AChangeOfRateKeepsThePhase) {
  const RobotItem snake = make_robot_item("snake");
  RobotLeg leg = kind_of(snake).still(snake);
  const auto phase_at = [](const RobotLeg& of, double time) { return number_of(of.figures, "rate") * time + number_of(of.figures, "phase"); };
  double time = 0;
  for (const double forward : {1.0, 0.5, 0.0, -1.0, 0.0}) {
    TeleopCommand asked;
    asked.forward = forward;
    const RobotLeg next = steer(snake, asked, leg, time, 1.0 / 60);
    EXPECT_NEAR(phase_at(next, time), phase_at(leg, time), 1e-12);
    EXPECT_EQ(number_of(next.figures, "rate"), 4 * forward);
    leg = next;
    time += 1.7;
  }
}

TEST(Teleop, FlippersGoOnFromWhereTheyAre) {
  const RobotItem crawler = make_robot_item("crawler");
  TeleopCommand asked;
  asked.pitch = -1, asked.roll = -1, asked.forward = 0.5, asked.speed = 0.4;
  asked.linear.x = 0.1;
  RobotLeg leg = steer(crawler, asked, {}, 0, 1);
  leg = steer(crawler, asked, leg, 1, 1);
  EXPECT_NEAR(leg.flippers_deg[0], 57.29577951308232 + 90, 1e-9);
  EXPECT_NEAR(leg.flippers_deg[3], 57.29577951308232 - 90, 1e-9);
  EXPECT_NEAR(leg.linear, 0.3, 1e-12);
}

}  // namespace robot_drive_test
}  // namespace rubble::testing
