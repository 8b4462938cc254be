// Missions whose robots come from URDF files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "app/robots/robot_files.h"
#include "app/robots/robot_log.h"
#include "kernel/robot/drive_commands.h"
#include "kernel/robot/odometry.h"
#include "kernel/robot/robot_run.h"
#include "scripting/robots/crawler.h"
#include "scripting/robots/rover.h"
#include "kernel/world/world_robots.h"
#include "tests/app/urdf_robots.h"

namespace rubble::testing {
namespace urdf_test {

// A camera's link of the robot beside the frame of the mission's camera.
TEST(Urdf, FramesOfRobotsDoNotClashWithThoseOfSensors) {
  Scenario scenario;
  scenario.robots.resize(1);
  scenario.robots[0].name = "bot";
  const auto with = [](std::string text, const std::string& name) {
    for (std::size_t at = 0; (at = text.find("\"mast\"", at)) != std::string::npos; ++at) text.replace(at, 6, "\"" + name + "\"");
    return text;
  };
  const auto record_of = [&](const std::string& name) {
    return describe_robots(scenario, {read_robot(with(kCart, name))}).front();
  };
  EXPECT_EQ(record_of("mast").frame, "");
  EXPECT_EQ(record_of("base_mast").frame_of(0), "base_footprint");
  for (const char* taken : {"camera_link", "camera_optical_frame", "odom", "world"}) {
    const RobotRecord record = record_of(taken);
    EXPECT_EQ(record.frame, "bot/") << taken;
    EXPECT_EQ(record.topic, "") << "topics are not frames";
  }
  EXPECT_EQ(record_of("/X1/mast").frame_named("/X1/mast"), "X1/mast") << "tf2 refuses slashes in front";
  EXPECT_EQ(record_of("L\xc3\xb6we").frame_named("L\xc3\xb6we"), "L\xc3\xb6we");
  scenario.imus.resize(1);
  scenario.imus[0].frame_id = "bot/mast";
  EXPECT_EQ(record_of("mast").frame, "") << "bot/mast is another frame than mast";
  scenario.imus[0].frame_id = "bot/camera_link";
  EXPECT_THROW(record_of("camera_link"), InputError);
}

// The bundled crawler by its file, with names that say nothing of sides: its tracks are those that the mission names.
TEST(Urdf, TracksAreThoseOfTheMission) {
  CrawlerOptions options;
  options.flippers = false;
  const RobotModel bundled = make_crawler(options);
  const ScratchFolder scratch;
  write_robot_description(scratch.path().string(), "tank", bundled);
  for (const auto& [from, to] : {std::pair{"left_track", "port"}, {"right_track", "starboard"}}) {
    std::string text = read_file(scratch / "tank.urdf");
    for (std::size_t at = 0; (at = text.find("\"" + std::string(from) + "\"", at)) != std::string::npos;)
      text.replace(at + 1, std::string(from).size(), to);
    write_file(scratch / "tank.urdf", text);
  }
  RobotItem item;
  item.urdf = scratch / "tank.urdf";
  item.left_tracks = {"port"}, item.right_tracks = {"starboard"}, item.track_speed = options.speed;
  MeshImporter importer;
  const MissionRobot read = make_mission_robot(item, {""}, "robots[1]", importer);
  EXPECT_NEAR(read.model.sides.distance, kCrawlerTrackDistance, 1e-6);
  ASSERT_EQ(read.model.links.size(), 3u);  // welds, yet bodies of their own

  const auto end_of = [](const RobotModel& model, double linear, double angular) {
    RobotRunOptions run_options;
    run_options.duration = 2, run_options.threads = 1;
    RobotRun run({}, {}, run_options);
    run.add(model, {{}, {0, 0, 0.001}}, [&](const RobotSense&) { return drive_sides(model, linear, angular); });
    run.run();
    return run.world().robots().state(0).links[0].world_from_link;
  };
  const Pose ahead = end_of(read.model, 0.3, 0), as_bundled = end_of(bundled, 0.3, 0);
  EXPECT_NEAR(ahead.translation.x, as_bundled.translation.x, 0.02);
  EXPECT_GT(ahead.translation.x, 0.5);
  EXPECT_NEAR(ahead.translation.y, 0, 0.02);
  const Vec3 nose = end_of(read.model, 0, 1).rotation.rotate({1, 0, 0});
  EXPECT_GT(nose.y, 0.3) << "a positive rate of turn is to the left";

  const auto mistake_of = [&](const std::function<void(RobotItem&)>& change) {
    RobotItem wrong = item;
    change(wrong);
    try {
      make_mission_robot(wrong, {""}, "robots[1]", importer);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(mistake_of([](RobotItem& r) { std::swap(r.left_tracks, r.right_tracks); }).find("robots[1].left_tracks: the left tracks are not left"),
            std::string::npos);
  EXPECT_NE(mistake_of([](RobotItem& r) { r.left_tracks = {"prot"}; }).find("robots[1].left_tracks: the robot has no such link"), std::string::npos);
}

// A car whose rear axle is driven: base_link above the front axle, or above the rear one.
std::string car(double rear, const std::string& more = "") {
  std::string text = "<robot name=\"car\"><link name=\"base_link\"><inertial><origin xyz=\"" + std::to_string(rear + 0.3) +
                     " 0 0.15\"/><mass value=\"20\"/><inertia ixx=\"0.3\" iyy=\"0.8\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
  const auto link = [&](const std::string& name, const std::string& inside) { text += "<link name=\"" + name + "\">" + inside + "</link>"; };
  const auto joint = [&](const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                         const std::string& place, const std::string& axis, const std::string& limit) {
    text += "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/><origin xyz=\"" +
            place + "\"/><axis xyz=\"" + axis + "\"/>" + limit + "</joint>";
  };
  const std::string wheel = "<inertial><mass value=\"1\"/><inertia ixx=\"0.004\" iyy=\"0.005\" izz=\"0.004\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
                            "<collision><geometry><sphere radius=\"0.1\"/></geometry></collision>";
  const std::string hub = "<inertial><mass value=\"0.5\"/><inertia ixx=\"0.002\" iyy=\"0.002\" izz=\"0.002\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
  for (const auto& [side, y] : {std::pair{std::string("left"), "0.2"}, {std::string("right"), "-0.2"}}) {
    link(side + "_hub", hub), link("front_" + side, wheel), link("rear_" + side, wheel);
    joint(side + "_steer", "revolute", "base_link", side + "_hub", std::to_string(rear + 0.6) + " " + y + " 0.1", side == "left" ? "0 0 1" : "0 0 -1",
          "<limit lower=\"-0.6\" upper=\"0.6\" effort=\"30\" velocity=\"5\"/>");
    joint("front_" + side + "_wheel", "continuous", side + "_hub", "front_" + side, "0 0 0", "0 1 0", "");
    joint("rear_" + side + "_wheel", "continuous", "base_link", "rear_" + side, std::to_string(rear) + " " + y + " 0.1", "0 1 0",
          "<limit effort=\"8\" velocity=\"20\"/>");
  }
  return text + more + "</robot>";
}

RobotItem car_item() {
  RobotItem item;
  item.left_wheels = {"rear_left_wheel"}, item.right_wheels = {"rear_right_wheel"}, item.wheel_radius = 0.1;
  item.steering = {"left_steer", "right_steer"};
  return item;
}

// The curve of a twist, to both sides and backwards; odometry follows it from wherever the base is.
TEST(Urdf, ACarFollowsTheCurveThatItIsAskedFor) {
  for (const double rear : {0.0, -0.6}) {
    const RobotModel model = read_robot(car(rear), car_item()).model;
    EXPECT_NEAR(model.sides.axle, rear, 1e-9);
    for (const auto& [linear, angular] : {std::pair{0.5, 0.25}, {0.5, -0.25}, {-0.4, 0.2}}) {
      RobotRunOptions options;
      options.threads = 1;
      RobotRun run({}, {}, options);
      WheelOdometry odometry(model);
      OdometryReading reading;
      const double v = linear, w = angular;
      run.add(model, {{}, {0, 0, 0.001}}, [&](const RobotSense& sense) {
        reading = odometry.update(sense.state, sense.time);
        return drive_sides(model, v, w);
      });
      run.begin();
      double turned = 0;
      Pose before = run.world().robots().state(0).links[0].world_from_link;
      for (int i = 0; i < 960; ++i) {
        run.step();
        const Pose now = run.world().robots().state(0).links[0].world_from_link;
        const Vec3 x = before.rotation.conjugate().rotate(now.rotation.rotate({1, 0, 0}));
        turned += std::atan2(x.y, x.x);
        before = now;
      }
      EXPECT_NEAR(turned, 4 * w, 0.15 * std::abs(4 * w)) << rear << " " << v << " " << w;
      EXPECT_NEAR(reading.yaw, turned, 0.08) << rear << " " << v << " " << w;
      EXPECT_NEAR(reading.x, before.translation.x, 0.1) << rear << " " << v << " " << w;
      EXPECT_NEAR(reading.y, before.translation.y, 0.1) << rear << " " << v << " " << w;
    }
  }
}

// Closed forms: inner and outer wheel (Ackermann), the narrowest curve, standing.
TEST(Urdf, ACarSteersEachWheelAlongItsOwnCircle) {
  const RobotModel model = read_robot(car(0), car_item()).model;
  const auto joint = [&](const char* name) {
    for (std::size_t i = 0; i < model.joints.size(); ++i)
      if (model.joints[i].name == name) return i;
    return std::size_t(0);
  };
  const RobotCommand left = drive_sides(model, 0.5, 0.25);  // about a point 2 m to the left
  EXPECT_NEAR(left.joints[joint("left_steer")].target, std::atan(0.6 / 1.8), 1e-9);
  EXPECT_NEAR(left.joints[joint("right_steer")].target, -std::atan(0.6 / 2.2), 1e-9) << "its axis points down";
  EXPECT_NEAR(left.joints[joint("rear_left_wheel")].target, 0.25 * 1.8 / 0.1, 1e-9);
  EXPECT_NEAR(left.joints[joint("rear_right_wheel")].target, 0.25 * 2.2 / 0.1, 1e-9);
  const RobotCommand narrow = drive_sides(model, 0.5, 9);
  EXPECT_NEAR(narrow.joints[joint("left_steer")].target, 0.6, 1e-9);
  const double radius = 0.6 / std::tan(0.6) + 0.2;  // of the rear axle's middle
  EXPECT_NEAR(narrow.joints[joint("right_steer")].target, -std::atan(0.6 / (radius + 0.2)), 1e-9);
  EXPECT_NEAR(narrow.joints[joint("rear_left_wheel")].target, 0.5 * (radius - 0.2) / radius / 0.1, 1e-9);
  const RobotCommand spot = drive_sides(model, 0, -1);
  EXPECT_NEAR(spot.joints[joint("right_steer")].target, 0.6, 1e-9);
  EXPECT_EQ(spot.joints[joint("rear_left_wheel")].target, 0) << "it does not turn on the spot";
}

TEST(Urdf, WheelsThatWouldNotDriveRightAreMistakesByTheirNames) {
  const auto mistake_of = [](const std::string& text, const std::function<void(RobotItem&)>& change) {
    RobotItem item = car_item();
    change(item);
    return mistake_in(text, item);
  };
  EXPECT_NE(mistake_of(car(0), [](RobotItem& r) { r.steering.clear(); })
                .find("robots[1].steering: the joint steers the wheel `front_left_wheel`: expected \"left_steer\" in `steering`"),
            std::string::npos) << mistake_of(car(0), [](RobotItem& r) { r.steering.clear(); });
  EXPECT_NE(mistake_of(car(0), [](RobotItem& r) { r.steering = {"left_steer"}; }).find("\"right_steer\" in `steering`"), std::string::npos);
  EXPECT_NE(mistake_of(car(0), [](RobotItem& r) { r.steering = {"left_steer", "right_steer", "rear_left_wheel"}; }).find("not a joint that steers"),
            std::string::npos);
  const std::string roller = "<link name=\"roller\"><inertial><mass value=\"0.1\"/><inertia ixx=\"1e-4\" iyy=\"1e-4\" izz=\"1e-4\" ixy=\"0\" "
                             "ixz=\"0\" iyz=\"0\"/></inertial></link><joint name=\"roll\" type=\"continuous\"><parent link=\"rear_left\"/><child "
                             "link=\"roller\"/><origin xyz=\"0 0 -0.09\"/><axis xyz=\"1 1 0\"/></joint>";
  EXPECT_NE(mistake_of(car(0, roller), [](RobotItem&) {}).find("robots[1].left_wheels: the wheel has rollers: mecanum"), std::string::npos);
  EXPECT_NE(mistake_of(car(0, roller), [](RobotItem&) {}).find("\"rear_left_wheel\" with \"roll\""), std::string::npos);
}

// Through the program: a mission with a file beside it, verified from its manifest.
TEST(Urdf, AMissionDrivesARobotFromAFile) {
  const ScratchFolder scratch;
  write_robot_description(scratch.path().string(), "rover", make_rover());
  write_file(scratch / "m.lua", R"(return rubble.mission { pile = { layers = 0 },
    robots = { { urdf = "rover.urdf", name = "buggy", position = { 0, 0, 0.001 }, friction = 0.8,
      left_wheels = { "front_left_wheel_joint", "rear_left_wheel_joint" },
      right_wheels = { "front_right_wheel_joint", "rear_right_wheel_joint" }, wheel_radius = 0.098,
      drive = { { t = 0, linear = 0.5 } } } },
    robot_run = { duration = 2 }, camera = { width = 32, height = 32 },
    trajectory = { rate_hz = 2, ride = { robot = "buggy", position = { 0.3, 0, 0.3 } } },
    outputs = { bag = false, rawlog = false, simplemap = false } })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(read_file(scratch / "out/robots/buggy_odometry.csv").find("slip_left"), std::string::npos);
  const Outcome verified = run_rubble("verify " + (scratch / "out"));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

// One run with much of what files of the field have: Latin-1, a transmission, a mast without collision, a knee whose range
// has no 0, a link with the name of the camera's frame.
TEST(Urdf, AMissionDrivesARobotOfTheField) {
  const ScratchFolder scratch;
  const std::string moves = "<limit lower=\"-2.6\" upper=\"-0.8\" effort=\"20\" velocity=\"15\"/>";
  std::string text = arm("revolute", moves, "<visual><geometry><box size=\"0.1 0.1 0.4\"/></geometry></visual>" + std::string(kArmMass));
  text = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" + replaced(text, "robot name=\"r\"", "robot name=\"R\xe4upe\"");
  text = replaced(text, "</robot>", "<link name=\"camera_link\"/><joint name=\"c\" type=\"fixed\"><parent link=\"base_link\"/>"
                  "<child link=\"camera_link\"/></joint><transmission name=\"t\"><joint name=\"j\"/></transmission></robot>");
  write_file(scratch / "r.urdf", text);
  write_file(scratch / "m.lua", R"(return rubble.mission { pile = { layers = 0 },
    robots = { { urdf = "r.urdf", name = "bot", position = { 0, 0, 0.4 }, start = { j = -1 } } },
    robot_run = { duration = 0.1 }, camera = { width = 16, height = 16 },
    trajectory = { rate_hz = 0.1, ride = { robot = "bot", link = "camera_link" } },
    outputs = { rawlog = false, simplemap = false } })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(text.find("<transmission")), '\n');
  EXPECT_NE(run.err.find("r.urdf:" + std::to_string(line) + ": <transmission> is left out"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("its link `camera_link` has the name of another frame of the mission"), std::string::npos) << run.err;
  EXPECT_NE(read_file(scratch / "out/robots/robots.json").find("\"model\": \"R\xc3\xa4upe\""), std::string::npos);
  EXPECT_NE(read_file(scratch / "out/robots/package.xml").find("<name>rubble_robots</name>"), std::string::npos);
  const std::string joints = read_file(scratch / "out/robots/bot_joints.csv");
  EXPECT_NE(joints.find("j_position"), std::string::npos);
  EXPECT_NE(joints.find(",-1,"), std::string::npos) << "the start: " << joints;
  // More values than motors.
  write_file(scratch / "n.lua", replaced(read_file(scratch / "m.lua"), "start = { j = -1 }", "drive = { { t = 0, joints = { -1, 2 } } }"));
  const Outcome more = run_rubble("run " + (scratch / "n.lua") + " --out " + (scratch / "more"));
  EXPECT_EQ(more.exit_code, 1);
  EXPECT_NE(more.err.find("n.lua:2: robots[1].drive[1].joints: not as many values as the robot has motors at "
                          "joints: expected 1: j, found 2"), std::string::npos) << more.err;
}

// Where a user stands most often: files that the mission names have no folder in their path then.
TEST(Urdf, AMissionIsRunFromItsOwnFolder) {
  const ScratchFolder scratch;
  write_robot_description(scratch.path().string(), "rover", make_rover());
  write_file(scratch / "hill.obj", "v -4 -4 0.1\nv 4 -4 0.1\nv 4 4 0.1\nv -4 4 0.1\nv 0 0 0.4\n"
                                   "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  write_file(scratch / "m.lua", R"(return rubble.mission {
  pile = { layers = 1, pieces_per_layer = 3, terrain = { file = "hill.obj" } },
  robots = { { urdf = "rover.urdf", name = "rover", position = { 0, -3, 1 } } }, robot_run = { duration = 0.1 },
  camera = { width = 32, height = 24 },
  trajectory = { waypoints = { { position = { -6, 0, 3 }, look_at = { 0, 0, 0 } } } },
})");
  const std::string command = "cd '" + scratch.path().string() + "' && '" RUBBLE_PROGRAM "' run m.lua --quiet --out out 2>err";
  const int status = std::system(command.c_str());
  EXPECT_EQ(status, 0) << read_file(scratch / "err");
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/manifest.json"));
}

}  // namespace urdf_test
}  // namespace rubble::testing
