// Mistakes in missions with robots: the message names the place and says what to do.
#include <gtest/gtest.h>

#include <string>

#include "tests/app/program.h"

namespace rubble::testing {
namespace robot_mistakes_test {

// What the program says of a mission.
Outcome run_mission(const ScratchFolder& scratch, const std::string& text) {
  write_file(scratch / "m.lua", text);
  return run_rubble("run " + (scratch / "m.lua") + " --force --out " + (scratch / "out"));
}

TEST(RobotMistakes, AControllerThatReturnsNoNumberIsAMistakeWithItsLine) {
  const ScratchFolder scratch;
  const Outcome run = run_mission(scratch,
                                  "return rubble.mission { pile = { layers = 0 },\n"
                                  "  robots = { rubble.robot.rover { position = { 0, 0, 0.001 },\n"
                                  "    control = function() return { linear = 0 / 0 } end } } }\n");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("m.lua:2: robots[1].control: linear"), std::string::npos) << run.err;
}

TEST(RobotMistakes, SensorsOnRobotsThatCannotCarryThemAreMistakesWithTheirLine) {
  const ScratchFolder scratch;
  const struct {
    const char *line, *expected;
  } cases[] = {
      {"cameras = { a = { ride = { robot = \"q\" } } }", "m.lua:3: cameras.a.ride.robot: no robot has this name"},
      {"cameras = { a = { ride = { robot = \"r\", link = \"mast\" } } }",
       "m.lua:3: cameras.a.ride.link: the robot has no such link: expected one of base_link"},
      {"imu = { ride = { link = \"mast\" } }", "m.lua:3: imu.ride.link: a link without a robot"},
      {"imu = true, imus = { a = {} }", "m.lua:3: imu.on: contradicts imus"},
      {"cameras = { a = { ride = { robot = \"r\" } } }, imu = true",
       "m.lua:3: cameras: no camera is on the rig, but another sensor is"},
      {"outputs = { euroc = true }, cameras = { a = { ride = { robot = \"r\" } }, b = {} }",
       "m.lua:3: outputs.euroc: the format has one moving body"},
      {"outputs = { euroc = true }, imu = { on = true, ride = { robot = \"r\" } }",
       "m.lua:3: imu.ride: outputs.euroc has one moving body, that of the cameras: expected a unit on the flying rig, or another "
       "format, found one on the first link of \"r\""},
  };
  for (const auto& c : cases) {
    const Outcome run = run_mission(
        scratch, std::string("return rubble.mission { pile = { layers = 0 },\n"
                             "  robots = { rubble.robot.rover { name = \"r\", position = { 0, 0, 0.001 } } },\n  ") + c.line + " }\n");
    EXPECT_EQ(run.exit_code, 1) << c.line;
    EXPECT_NE(run.err.find(c.expected), std::string::npos) << c.line << "\n" << run.err;
  }
}

TEST(RobotMistakes, ALinkThatIsNotThereIsAMistakeWithItsLine) {
  const ScratchFolder scratch;
  const Outcome run = run_mission(scratch,
                                  "return rubble.mission { pile = { layers = 0 },\n"
                                  "  robots = { rubble.robot.rover { name = \"r\", position = { 0, 0, 0.001 } } },\n"
                                  "  trajectory = { ride = { robot = \"r\", link = \"mast\" } } }\n");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("m.lua:3: trajectory.ride.link: the robot has no such link: expected one of "
                         "base_link, front_left_wheel"),
            std::string::npos)
      << run.err;
}

// A function that never returns is stopped by the sandbox; what is too much for a motor is a mistake.
TEST(RobotMistakes, ControllersThatNeverReturnOrAskTooMuchAreMistakesWithTheirLine) {
  const ScratchFolder scratch;
  const struct {
    const char *body, *expected;
  } cases[] = {{"while true do end", "m.lua:3"},
               {"return { torques = { 1e9 } }", "robots[1].control: torques"},
               {"return { linear = 80 }", "robots[1].control: linear"},
               {"return 5", "robots[1].control: the function returned no valid commands"},
               {"return { joints = { 1, 2, 3, 4 } }",
                "robots[1].control: joints: the motor of front_left_wheel_joint turns at a speed and holds no position, at t = 0 s"},
               {"return { flippers = { 1 } }", "robots[1].control: flippers: unknown key"},
               {"rubble.reject(\"me\", \"key\", \"a number\", 1)", "expected a number"},
               {"error(\"no idea\")", "robots[1].control: no idea, at t = 0 s"}};
  for (const auto& c : cases) {
    const Outcome run = run_mission(
        scratch, std::string("return rubble.mission { pile = { layers = 0 },\n"
                             "  robots = { rubble.robot.rover { position = { 0, 0, 0.001 }, control = function()\n") + c.body + "\nend } } }\n");
    EXPECT_EQ(run.exit_code, 1) << c.body;
    EXPECT_NE(run.err.find(c.expected), std::string::npos) << c.body << "\n" << run.err;
  }
}

TEST(RobotMistakes, CommandsOfOtherRobotsAreMistakes) {
  const ScratchFolder scratch;
  const struct {
    const char *robot, *leg, *expected;
  } cases[] = {
      {"rover", "joints = { 1, 2, 3, 4 }", "drive[1].joints: the motor of front_left_wheel_joint turns at a speed and holds no position"},
      {"rover", "joints = { 1 }, joint_names = { \"rear_left_wheel_joint\" }", "drive[1].joints: the motor of rear_left_wheel_joint"},
      {"rover", "flippers_deg = { 9, 9, 9, 9 }", "drive[1].flippers_deg: more angles than the robot has flippers: expected 0 at most"},
      {"rover", "growth = 0.1", "drive[1]: a command of another robot: expected what a rover does, found one of growth"},
      {"crawler", "gait = \"rolling\"", "drive[1]: a command of another robot: expected what a crawler does, found one of gait"},
      {"crawler { flippers = false }", "flippers_deg = { 9, 9, 9, 9 }", "drive[1].flippers_deg: more angles"},
      {"snake", "linear = 0.3", "drive[1].linear: this robot has neither tracks nor driven wheels: expected 0, found 0.3"},
      {"vine", "angular = 0.3", "drive[1].angular: this robot has neither tracks nor driven wheels"},
  };
  for (const auto& c : cases) {
    const std::string robot = c.robot, table = robot.find('{') == std::string::npos ? robot + " {}" : robot;
    const Outcome run = run_mission(scratch, "local r = rubble.robot." + table + "\nr.position, r.drive = { 0, 0, 0.06 }, { { " + c.leg +
                                                 " } }\nreturn rubble.mission { pile = { layers = 0 }, robots = { r } }\n");
    EXPECT_EQ(run.exit_code, 1) << c.robot << c.leg;
    EXPECT_NE(run.err.find(c.expected), std::string::npos) << c.robot << c.leg << "\n" << run.err;
  }
}

TEST(RobotMistakes, ANumberIsNoController) {
  const ScratchFolder scratch;
  const Outcome run = run_mission(scratch, "return rubble.mission { pile = { layers = 0 },\n  robots = { rubble.robot.rover { control = 5 } } }\n");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("m.lua:2: robots[1].control: the script registers no function 5"), std::string::npos) << run.err;
}

TEST(RobotMistakes, ARobotUnderWhichThereIsNoRoomIsNotSentDown) {
  const ScratchFolder scratch;
  const Outcome run = run_mission(scratch,
                                  "return rubble.mission {\n"
                                  "  pile = { layers = 0, placed = { { box = { 2, 2, 1 }, position = { 0, 0, 0.5 } } } },\n"
                                  "  robots = { rubble.robot.rover { position = { 0, 0, 0.005 } } } }\n");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("deep in"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find(", -0"), std::string::npos) << run.err;
}

TEST(RobotMistakes, ARobotInASlabIsAMistakeThatSaysWhereToPutIt) {
  const ScratchFolder scratch;
  const Outcome run = run_mission(scratch,
                                  "return rubble.mission {\n"
                                  "  pile = { layers = 0, placed = { { box = { 2, 2, 0.2 }, position = { 0, 0, 0.1 } } } },\n"
                                  "  robots = { rubble.robot.rover {\n"
                                  "    position = { 0, 0, 0.12 } } } }\n");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("m.lua:3: robots[1].position: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("stands 0.08"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("(piece 0)"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("move it by {0.000, 0.000, 0.08"), std::string::npos) << run.err;
}

}  // namespace robot_mistakes_test
}  // namespace rubble::testing
