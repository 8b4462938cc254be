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
               {"return { speeds = { 3 } }",
                "robots[1].control: speeds: not as many values as the robot has motors at joints, at t = 0 s: expected 4: "
                "front_left_wheel_joint, front_right_wheel_joint, rear_left_wheel_joint, rear_right_wheel_joint, found 1"},
               {"return { torques = { 1, 1, 1, 1, 1 } }", "found 5"},
               {"return { speeds = { 3, 3, 3, 3 }, torques = { 2, 2, 2, 2 } }",
                "robots[1].control: torques: contradicts speeds, at t = 0 s: expected one of both, found both"},
               {"return { linear = 0.5, speeds = { 0, 0, 0, 0 } }", "robots[1].control: speeds: contradicts linear"},
               {"return { angular = 0.5, speeds = { 1 }, joint_names = { \"rear_left_wheel_joint\" } }",
                "robots[1].control: speeds: contradicts angular"},
               {"return { speeds = { 1, 2 }, joint_names = { \"rear_left_wheel_joint\" } }",
                "robots[1].control: joint_names: not as many as speeds, at t = 0 s: expected 2 names, found 1"},
               {"return { speeds = { 1 }, joint_names = { \"tail\" } }",
                "robots[1].control: joint_names: the robot has no joint of this name with a motor"},
               {"return { joint_names = { \"rear_left_wheel_joint\" } }", "joint_names: names joints that are asked for nothing"},
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

TEST(RobotMistakes, ControllersOfOtherRobotsAreRefusedWhatTheyCannotDo) {
  const ScratchFolder scratch;
  const struct {
    const char *robot, *answer, *expected;
  } cases[] = {
      {"crawler {", "flippers = { 0.8 }", "robots[1].control: flippers: not as many values as the robot has motors at joints, at t = 0 s: "
                                        "expected 4: front_left_flipper_joint"},
      {"crawler {", "flippers = { 1, 1, 1, 1 }, joints = { 0, 0, 0, 0 }", "robots[1].control: joints: contradicts flippers"},
      {"snake { modules = 3,", "joints = { 0.5 }", "expected 2: joint_1, joint_2, found 1"},
      {"snake {", "linear = 0.5", "robots[1].control: linear: unknown key"},
  };
  for (const auto& c : cases) {
    const Outcome run = run_mission(scratch, std::string("return rubble.mission { pile = { layers = 0 }, robots = {\n  rubble.robot.") +
                                                 c.robot + " position = { 0, 0, 0.06 },\n  control = function() return { " + c.answer +
                                                 " } end } } }\n");
    EXPECT_EQ(run.exit_code, 1) << c.robot << c.answer;
    EXPECT_NE(run.err.find(c.expected), std::string::npos) << c.robot << c.answer << "\n" << run.err;
  }
}

// Belts are no motors at joints, and named joints leave the others alone.
TEST(RobotMistakes, AFunctionMayAskBeltsAndSomeOfTheMotors) {
  const ScratchFolder scratch;
  const char* const answers[] = {"linear = 0.2, joints = { 0.3, 0.4 }, joint_names = { \"front_left_flipper_joint\", "
                                 "\"rear_right_flipper_joint\" }",
                                 "linear = 0.2, speeds = { 0.1, 0.1, 0, 0 }"};
  for (const std::string answer : answers) {
    const Outcome run = run_mission(scratch, "return rubble.mission { pile = { layers = 0 }, robots = { rubble.robot.crawler { name = \"r\",\n"
                                             "  position = { 0, 0, 0.01 }, control = function() return { " + answer + " } end } },\n"
                                             "  robot_run = { duration = 2 }, camera = { width = 16, height = 16 },\n"
                                             "  trajectory = { rate_hz = 0.1, ride = { robot = \"r\" } }, outputs = { bag = false } }\n");
    EXPECT_EQ(run.exit_code, 0) << answer << "\n" << run.err;
  }
}

// A turn that belts or wheels have no speed left for; straight ahead there is none to lose.
TEST(RobotMistakes, ATwistBeyondTheSpeedOfTheSidesIsSaidOnce) {
  const ScratchFolder scratch;
  const auto said = [&](const std::string& robot, const std::string& drive) {
    return run_mission(scratch, "return rubble.mission { pile = { layers = 0 }, robots = { rubble.robot." + robot + " { name = \"r\",\n"
                                "  position = { 0, 0, 0.01 }, " + drive + " } }, robot_run = { duration = 0.2 },\n"
                                "  camera = { width = 16, height = 16 }, trajectory = { rate_hz = 0.1, ride = { robot = \"r\" } },\n"
                                "  outputs = { bag = false } }\n").err;
  };
  const std::string sentence = "linear = 1 with angular = 1 asks for 1.199 m/s on one side, which reaches 0.6 m/s";
  EXPECT_NE(said("crawler", "drive = { { linear = 1, angular = 1 } }").find("robots[1].drive[1]: " + sentence), std::string::npos);
  const std::string controlled = said("crawler", "control = function() return { linear = 1, angular = 1 } end");
  const std::size_t first = controlled.find("robots[1].control: " + sentence);
  EXPECT_NE(first, std::string::npos) << controlled;
  EXPECT_EQ(controlled.find(sentence, first + 30), std::string::npos) << controlled;
  EXPECT_NE(said("rover", "drive = { { linear = 1, angular = 1 } }").find("which reaches"), std::string::npos);
  for (const char* kept : {"drive = { { linear = 1 } }", "drive = { { angular = 9 } }", "drive = { { linear = 0.3, angular = 0.5 } }"})
    EXPECT_EQ(said("crawler", kept).find("which reaches"), std::string::npos) << kept;
}

// What the model of a robot says against the mission needs no pile.
TEST(RobotMistakes, AreFoundBeforeThePileSettles) {
  const ScratchFolder scratch;
  const struct {
    const char *robot, *more, *expected;
  } cases[] = {
      {"rubble.robot.snake { drive = { { linear = 0.4 } } }", "", "m.lua:3: robots[1].drive[1].linear: this robot has neither"},
      {"rubble.robot.rover { drive = { { joints = { 1, 1, 1, 1 } } } }", "", "m.lua:3: robots[1].drive[1].joints: the motor of"},
      {"rubble.robot.rover { start = { tail = 1 } }", "", "m.lua:3: robots[1].start: the robot has no such joint"},
      {"rubble.robot.rover { name = \"r\" }", "trajectory = { ride = { robot = \"r\", link = \"mast\" } }",
       "m.lua:4: trajectory.ride.link: the robot has no such link"},
      {"rubble.robot.rover { name = \"r\" }", "imus = { i = { ride = { robot = \"r\", link = \"mast\" } } }",
       "m.lua:4: imus.i.ride.link: the robot has no such link"},
  };
  for (const auto& c : cases) {
    write_file(scratch / "m.lua", std::string("return rubble.mission {\n  pile = { layers = 3, pieces_per_layer = 2000 },\n  robots = { ") +
                                      c.robot + " },\n  " + c.more + " }\n");
    const std::string mission = scratch / "m.lua", out = " --out " + (scratch / "out");
    for (const std::string& command : {"check " + mission, "settle " + mission + out, "run " + mission + out,
                                       "batch " + mission + " --seeds 1..2" + out}) {
      const Outcome run = run_rubble(command);
      EXPECT_EQ(run.exit_code, 1) << command;
      EXPECT_NE(run.err.find(c.expected), std::string::npos) << command << "\n" << run.err;
      EXPECT_FALSE(std::filesystem::exists(scratch / "out/unfinished")) << command;
    }
  }
}

TEST(RobotMistakes, CommandsOfOtherRobotsAreMistakes) {
  const ScratchFolder scratch;
  const struct {
    const char *robot, *leg, *expected;
  } cases[] = {
      {"rover", "joints = { 1, 2, 3, 4 }", "drive[1].joints: the motor of front_left_wheel_joint turns at a speed and holds no position"},
      {"rover", "joints = { 1 }, joint_names = { \"rear_left_wheel_joint\" }", "drive[1].joints: the motor of rear_left_wheel_joint"},
      {"rover", "flippers_deg = { 9, 9, 9, 9 }", "drive[1].flippers_deg: this robot has no tracks, and so no flippers: expected nothing, found 4"},
      {"rover", "growth = 0.1", "drive[1]: a command of another robot: expected what a rover does, found one of growth"},
      {"crawler", "gait = \"rolling\"", "drive[1]: a command of another robot: expected what a crawler does, found one of gait"},
      {"crawler { flippers = false }", "flippers_deg = { 9, 9, 9, 9 }", "drive[1].flippers_deg: not as many values as the robot has motors at joints: "
                                        "expected none: no joint has a motor, found 4"},
      {"snake { modules = 3 }", "joints = { 0.5 }",
       "drive[1].joints: not as many values as the robot has motors at joints: expected 2: joint_1, joint_2, found 1"},
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
