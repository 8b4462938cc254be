// Robots of a mission: keys, constructors, functions as controllers.
#include <gtest/gtest.h>

#include "kernel/base/error.h"
#include "scripting/mission.h"

namespace rubble {
namespace {

Scenario scenario_of(const std::string& text) { return load_mission_text(text, "m.lua").scenario; }

std::string error_of(const std::string& text) {
  try {
    scenario_of(text);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "none";
}

TEST(RobotKeys, AConstructorGivesAnEntry) {
  const Scenario s = scenario_of(R"(return rubble.mission { robots = {
    rubble.robot.snake { name = "adder", modules = 8, position = { 1, 2, 3 },
                         drive = { { t = 0, gait = "rolling" }, { t = 2, rate = -3 } } },
    rubble.robot.crawler { flippers = false, friction = 0.6 } },
    robot_run = { duration = 4, debris = "fixed" } })");
  ASSERT_EQ(s.robots.size(), 2u);
  EXPECT_EQ(s.robots[0].model, RobotKind::snake);
  EXPECT_EQ(s.robots[0].modules, 8);
  EXPECT_EQ(s.robots[0].position.y, 2);
  ASSERT_EQ(s.robots[0].drive.size(), 2u);
  EXPECT_EQ(s.robots[0].drive[0].gait, GaitKind::rolling);
  EXPECT_EQ(s.robots[0].drive[1].rate, -3);
  EXPECT_FALSE(s.robots[1].flippers);
  EXPECT_EQ(s.robots[1].friction, 0.6);
  EXPECT_EQ(robot_names(s.robots), (std::vector<std::string>{"adder", "crawler_2"}));
  EXPECT_EQ(s.robot_run.debris, DebrisMotion::fixed);
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "j")), scenario_to_json(s));
}

TEST(RobotKeys, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(error_of("return rubble.mission { robots = {\n  rubble.robot.crawler { flipers = true } } }"),
            "m.lua:2: rubble.robot.crawler.flipers: unknown key `flipers` (did you mean `flippers`?)");
  EXPECT_EQ(error_of("return rubble.mission { robots = { { model = \"rover\", name = \"a/b\" } } }"),
            "m.lua:1: robots[1].name: cannot name a file: expected letters, digits and _, found "
            "\"a/b\"");
  EXPECT_NE(error_of("return rubble.mission { robots = { { model = \"rover\", drive = { { t = 2 }, { "
                     "t = 1 } } } } }")
                .find("robots[1].drive[2].t: not in order"),
            std::string::npos);
  EXPECT_NE(error_of("return rubble.mission { robots = { { model = \"crawler\", drive = { { "
                     "flippers_deg = { 1, 2 } } } } } }")
                .find("flippers_deg: wrong number of angles"),
            std::string::npos);
}

TEST(RobotControl, AFunctionIsCalledAfterTheScriptHasEnded) {
  LuaSandbox sandbox(1, "rubble.mission");
  const Value table = sandbox.run(R"(local calls = 0
    return { robots = { rubble.robot.rover { control = function(sense)
      calls = calls + 1
      return { linear = sense.t * 2, angular = calls }
    end } } })", "m.lua");
  ASSERT_EQ(table.find("robots")->items[0].find("control")->integer, 1);
  Value sense = Value::make_table();
  sense.set("t", Value::make_number(0.25));
  sandbox.call_controller(1, sense);
  const Value answer = sandbox.call_controller(1, sense);
  EXPECT_EQ(answer.find("linear")->number, 0.5);
  EXPECT_EQ(answer.find("angular")->number, 2);
}

TEST(RobotControl, AFunctionThatDoesNotEndIsStopped) {
  LuaSandbox sandbox(1, "rubble.mission");
  sandbox.run("rubble.controller(function()\n while true do end\nend)\nreturn {}", "m.lua");
  try {
    sandbox.call_controller(1, Value::make_table());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().back().line, 2);
    EXPECT_NE(error.diagnostics().back().message.find("does not end"), std::string::npos);
  }
}

TEST(RobotControl, AnErrorHasItsLine) {
  LuaSandbox sandbox(1, "rubble.mission");
  sandbox.run("rubble.controller(function(s)\n\n return s.nothing.at_all\nend)\nreturn {}", "m.lua");
  try {
    sandbox.call_controller(1, Value::make_table());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().back().line, 3);
  }
}

}  // namespace
}  // namespace rubble
