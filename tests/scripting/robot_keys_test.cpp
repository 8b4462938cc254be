// Robots of a mission: keys, constructors, functions as controllers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "kernel/base/error.h"
#include "scripting/mission.h"
#include "scripting/robots/robot_kind.h"
#include "tests/scripting/robot_figures.h"

namespace rubble {
namespace robot_keys_test {

using testing::figure_of, testing::number_of;

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
  EXPECT_EQ(kind_of(s.robots[0]).name(), "snake");
  EXPECT_EQ(number_of(s.robots[0].figures, "modules"), 8);
  EXPECT_EQ(s.robots[0].position.y, 2);
  ASSERT_EQ(s.robots[0].drive.size(), 2u);
  EXPECT_EQ(figure_of(s.robots[0].drive[0].figures, "gait").text, "rolling");
  EXPECT_EQ(number_of(s.robots[0].drive[1].figures, "rate"), -3);
  EXPECT_FALSE(figure_of(s.robots[1].figures, "flippers").boolean);
  EXPECT_EQ(s.robots[1].friction, 0.6);
  EXPECT_EQ(robot_names(s.robots), (std::vector<std::string>{"adder", "crawler_2"}));
  EXPECT_EQ(s.robot_run.debris, DebrisMotion::fixed);
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "j")), scenario_to_json(s));
}

// A robot from outside of the tree: keys, commands, what a driver asks for.
class Sled : public RobotKind {
 public:
  struct Figures : FiguresOf<Figures> {
    double runners = 2;
    void add_keys(Schema& k) override { k.value("runners", runners, "Sled: number of runners.").between(1, 4); }
    bool operator==(const Figures& other) const { return runners == other.runners; }
  };
  struct Command : FiguresOf<Command> {
    double pull = 0;
    void add_keys(Schema& k) override { k.value("pull", pull, "Sled: force.").between(0, 100).unit("N"); }
    bool operator==(const Command& other) const { return pull == other.pull; }
  };
  std::string name() const override { return "sled"; }
  std::unique_ptr<RobotFigures> figures() const override { return std::make_unique<Figures>(); }
  std::unique_ptr<RobotFigures> command_figures() const override { return std::make_unique<Command>(); }
  RobotModel make(const RobotItem& robot) const override {
    RobotModel model;
    model.name = "sled with " + std::to_string(int(robot.figures.of<Figures>().runners));
    return model;
  }
  void steer(const TeleopCommand& asked, const RobotItem&, const RobotLeg&, double, RobotLeg& leg) const override {
    leg.figures.of<Command>().pull = 50 * within(asked.forward, 1);
  }
};

void expect_sled_in_missions() {
  register_robot(std::make_unique<Sled>());
  EXPECT_THROW(register_robot(std::make_unique<Sled>()), InputError);
  const Scenario s = scenario_of("return rubble.mission { robots = { { model = \"sled\", runners = 3, drive = { { t = 0, pull = 7 } } }, "
                                 "{ model = \"vine\", length = 2 } } }");
  EXPECT_EQ(kind_of(s.robots[0]).make(s.robots[0]).name, "sled with 3");
  EXPECT_EQ(number_of(s.robots[0].drive[0].figures, "pull"), 7);
  EXPECT_EQ(number_of(s.robots[1].figures, "length"), 2);
  EXPECT_EQ(robot_names(s.robots), (std::vector<std::string>{"sled_1", "vine_2"}));
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "j")), scenario_to_json(s));
  EXPECT_NE(error_of("return rubble.mission { robots = { { model = \"sled\", runners = 9 } } }").find("robots[1].runners"), std::string::npos);
  TeleopCommand asked;
  asked.forward = 2;
  RobotLeg leg = s.robots[0].drive[0];
  kind_of(s.robots[0]).steer(asked, s.robots[0], s.robots[0].drive[0], 0.1, leg);
  EXPECT_EQ(number_of(leg.figures, "pull"), 50);
  EXPECT_FALSE(same_command(leg, s.robots[0].drive[0]));
}

// In a process of its own: other tests read documents of the bundled robots alone.
TEST(RobotKinds, ARobotIsRegisteredFromOutside) {
  EXPECT_EXIT((expect_sled_in_missions(), std::exit(HasFailure() ? 1 : 0)), ::testing::ExitedWithCode(0), "");
}

// A robot outside of its list would silently not exist.
TEST(RobotKinds, EveryFileOfARobotIsInTheList) {
  for (const auto& file : std::filesystem::directory_iterator(RUBBLE_SOURCE_DIR "/scripting/robots")) {
    const std::string name = file.path().filename().string(), end = "_kind.cpp";
    if (name == "robot" + end || name.size() <= end.size() || name.compare(name.size() - end.size(), end.size(), end) != 0) continue;
    EXPECT_EQ(kind_of(make_robot_item(name.substr(0, name.size() - end.size()))).name() + end, name);
  }
  EXPECT_THROW(make_robot_item("hovercraft"), InputError);
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
  EXPECT_NE(error_of("return rubble.mission { robots = { { model = \"crawler\", drive = { { "
                     "joints = { 1, 2 }, joint_names = { \"front_left_flipper_joint\" } } } } } }")
                .find("robots[1].drive[1].joint_names: not as many as joints: expected 2 names, found 1"),
            std::string::npos);
}

TEST(RobotKeys, FiguresOfJointsAreTablesByTheirNames) {
  const Scenario s = scenario_of(R"(return rubble.mission { robots = { { urdf = "a.urdf.xacro",
    urdf_arguments = { prefix = "left_", arms = "2" }, start = { knee = -1.5, ["X1/hip"] = 0.25 },
    efforts = { wheel = 5 }, speeds = { wheel = 3 } },
    rubble.robot.crawler { start = { front_left_flipper_joint = 0.5 } } } })");
  using Numbers = std::vector<std::pair<std::string, double>>;
  EXPECT_EQ(s.robots[0].start, (Numbers{{"X1/hip", 0.25}, {"knee", -1.5}}));
  EXPECT_EQ(s.robots[0].efforts, (Numbers{{"wheel", 5}}));
  EXPECT_EQ(s.robots[0].speeds, (Numbers{{"wheel", 3}}));
  ASSERT_EQ(s.robots[0].urdf_arguments.size(), 2U);
  EXPECT_EQ(s.robots[0].urdf_arguments[1].second, "left_");
  EXPECT_EQ(s.robots[1].start, (Numbers{{"front_left_flipper_joint", 0.5}}));
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "j")), scenario_to_json(s));
  const auto in_robot = [](const std::string& keys) { return error_of("return rubble.mission { robots = { { " + keys + " } } }"); };
  EXPECT_NE(in_robot("urdf = \"a\", start = { 1, 2 }").find("robots[1].start"), std::string::npos);
  EXPECT_NE(in_robot("urdf = \"a\", start = { knee = \"up\" }").find("expected a table { name = number }"), std::string::npos);
  EXPECT_NE(in_robot("urdf = \"a\", efforts = { w = -1 }").find("each from 0 to"), std::string::npos);
  EXPECT_NE(in_robot("efforts = { w = 1 }").find("robots[1].efforts: only a robot from a URDF file has these"), std::string::npos);
}

// Of topics, frames and labels of a rawlog: two of one name are a mistake, wherever the name comes from.
TEST(RobotKeys, NamesOfSensorsAreNotThoseOfRobots) {
  const auto with = [](const std::string& more) {
    return error_of("return rubble.mission { robots = { rubble.robot.rover { name = \"tank\" } }, " + more + " }");
  };
  EXPECT_EQ(with("imus = { front = { ride = { robot = \"tank\" } } }"), "none");
  for (const char* topic : {"/odom", "/joint_states", "/contacts", "/robot_description", "/ground_truth/odom", "/ground_truth/pose",
                            "/camera/rgb/image_raw", "/camera/depth_registered/image"})
    EXPECT_NE(with(std::string("imu = { topic = \"") + topic + "\" }").find("imu.topic: the name is taken"), std::string::npos) << topic;
  EXPECT_NE(with("imus = { odom = { ride = { robot = \"tank\" } } }").find("imus.odom: the name is taken"), std::string::npos);
  EXPECT_NE(with("imu = { frame_id = \"odom\" }").find("imu.frame_id: the name is taken"), std::string::npos);
  EXPECT_NE(with("camera = { frame_id = \"odom\" }").find("camera.frame_id: the name is taken"), std::string::npos);
  EXPECT_NE(with("cameras = { rig = {} }").find("cameras.rig: the name is taken"), std::string::npos);
  EXPECT_NE(with("cameras = { tank = { ride = { robot = \"tank\" } } }").find("two observations of the rawlog would have one label"),
            std::string::npos);
  EXPECT_EQ(with("cameras = { tank = { ride = { robot = \"tank\" } } }, outputs = { rawlog = false }"), "none");
  EXPECT_NE(error_of("return rubble.mission { cameras = { a = { stereo_baseline = 0.1 }, a_right = {} } }").find("the name is taken"),
            std::string::npos);
}

TEST(RobotKeys, AVineHasATubeAndGrows) {
  const Scenario s = scenario_of(R"(return rubble.mission { robots = {
    rubble.robot.vine { pressure = 2e4, radius = 0.04, length = 2.5, link_length = 0.04,
                        drive = { { t = 0, growth = 0.1 }, { t = 3, growth = 0.2, curvature = -1, curvature_up = 0.5 } } } } })");
  ASSERT_EQ(s.robots.size(), 1u);
  EXPECT_EQ(kind_of(s.robots[0]).name(), "vine");
  EXPECT_EQ(number_of(s.robots[0].figures, "pressure"), 2e4);
  EXPECT_EQ(number_of(s.robots[0].figures, "radius"), 0.04);
  EXPECT_EQ(number_of(s.robots[0].figures, "length"), 2.5);
  EXPECT_EQ(number_of(s.robots[0].drive[1].figures, "curvature"), -1);
  EXPECT_EQ(number_of(s.robots[0].drive[1].figures, "curvature_up"), 0.5);
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "j")), scenario_to_json(s));
  const auto vine = [](const std::string& keys) {
    return error_of("return rubble.mission { robots = {\n  rubble.robot.vine { " + keys + " } } }");
  };
  EXPECT_NE(vine("pressure = 0").find("m.lua:2: rubble.robot.vine.pressure: "), std::string::npos) << vine("pressure = 0");
  EXPECT_NE(vine("radius = 0").find("m.lua:2: rubble.robot.vine.radius: "), std::string::npos) << vine("radius = 0");
  EXPECT_EQ(vine("length = 0.03"),
            "m.lua:2: robots[1].length: shorter than a link: expected link_length (0.05 m) or more, found 0.03 m "
            "(a shorter link_length makes more of a short vine)");
  EXPECT_NE(vine("length = 99").find("robots[1].length: too many links: expected 254 links"), std::string::npos)
      << vine("length = 99");
}

// A vine as its controller is told of it.
struct Tip {
  Vec3 at{0, 0, 1}, forwards{1, 0, 0}, left{0, 1, 0};
  double length = 0;

  Value sense(double t) const {
    const auto list = [](const Vec3& v) {
      Value value = Value::make_table();
      for (int i = 0; i < 3; ++i) value.items.push_back(Value::make_number(v[i]));
      return value;
    };
    Value tip = Value::make_table(), truth = Value::make_table(), vine = Value::make_table(), sense = Value::make_table();
    tip.set("position", list(at)), tip.set("forwards", list(forwards)), tip.set("left", list(left));
    tip.set("up", list(cross(forwards, left)));
    truth.set("tip", tip), vine.set("length", Value::make_number(length));
    sense.set("t", Value::make_number(t)), sense.set("vine", vine), sense.set("truth", truth);
    return sense;
  }
};

double number_in(const Value& answer, const char* key) {
  const Value* found = answer.find(key);
  return found == nullptr ? 0 : found->number;
}

TEST(RobotControl, AVineGrowsAlongAPath) {
  LuaSandbox sandbox(1, "rubble.mission");
  sandbox.run("rubble.controller(rubble.robot.grow_along { path = { { 0, 0, 1 }, { 1, 0, 1 }, { 2, 0.6, 1.4 } }, "
              "speed = 0.2, lookahead = 0.3 })\nreturn {}", "m.lua");
  Tip tip;
  double t = 0, nearest = 1e9;
  for (; t < 20; t += 1.0 / 30) {
    const Value wish = sandbox.call_controller(1, tip.sense(t));
    const double grown = number_in(wish, "growth") / 30;
    if (grown == 0) break;
    const Vec3 bend = tip.left * number_in(wish, "curvature") +
                      cross(tip.forwards, tip.left) * number_in(wish, "curvature_up");
    tip.forwards = normalized(tip.forwards + bend * grown);
    tip.left = normalized(tip.left - tip.forwards * dot(tip.left, tip.forwards));
    tip.at += tip.forwards * grown;
    tip.length += grown;
    nearest = std::min(nearest, distance(tip.at, {2, 0.6, 1.4}));
  }
  EXPECT_LT(nearest, 0.05);
  EXPECT_GT(t, 8);
  EXPECT_LT(t, 14) << "it was to stop at the end of the path";
}

TEST(RobotControl, AVineThatIsStuckStopsGrowing) {
  LuaSandbox sandbox(1, "rubble.mission");
  sandbox.run("rubble.controller(rubble.robot.grow_along { path = { { 0, 0, 1 }, { 1, 0, 1 } }, stuck_after = 1 })\n"
              "return {}", "m.lua");
  const Tip tip;
  EXPECT_EQ(number_in(sandbox.call_controller(1, tip.sense(0)), "growth"), 0.2);
  EXPECT_EQ(number_in(sandbox.call_controller(1, tip.sense(0.9)), "growth"), 0.2);
  EXPECT_EQ(number_in(sandbox.call_controller(1, tip.sense(1.1)), "growth"), 0);
}

TEST(RobotKeys, ARideTakesAsLongAsTheRobotIsDriven) {
  const std::string robot = "robots = { rubble.robot.rover { name = \"r\" } }, robot_run = { duration = 3 }";
  const Scenario s = scenario_of("return rubble.mission { " + robot + R"(,
    trajectory = { rate_hz = 4, ride = { robot = "r", link = "base_link", position = { 0.2, 0, 0.3 },
                                         rpy_deg = { 0, 0, 90 } } } })");
  EXPECT_EQ(s.trajectory.ride.link, "base_link");
  EXPECT_LT(norm(s.trajectory.ride.link_from_rig().rotation.rotate({1, 0, 0}) - Vec3{0, 1, 0}), 1e-12);
  EXPECT_EQ(sample_trajectory(flown_trajectory(s), 0).size(), 13u);
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "j")), scenario_to_json(s));
  EXPECT_EQ(error_of("return rubble.mission { " + robot + ",\n  trajectory = { ride = { robot = \"x\" } } }"),
            "m.lua:2: trajectory.ride.robot: no robot has this name: expected one of r, found \"x\"");
  EXPECT_NE(error_of("return rubble.mission { " + robot +
                     ", trajectory = { ride = { robot = \"r\" }, plan = \"avoid\" } }")
                .find("trajectory.ride: the path of a robot cannot be changed"),
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

// A vehicle that does what it is told, at 30 Hz: where it has been when it stops.
struct Follower {
  double x = 0, y = 0, yaw = 0;
  double worst = 0;       // distance from the path; unit: m
  bool stopped = false;
  double corner = 1e9;    // nearest to (2, 1), the corner before the last leg; unit: m
};

double distance_to_leg(double x, double y, const Vec3& a, const Vec3& b) {
  const Vec3 p{x, y, 0}, u = b - a;
  const double s = std::clamp(dot(p - a, u) / dot(u, u), 0.0, 1.0);
  return distance(p, a + u * s);
}

Follower follow(const std::string& options, const char* sensed) {
  LuaSandbox sandbox(1, "rubble.mission");
  sandbox.run("rubble.controller(rubble.robot.follow { path = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 0, 1 } }, " +
                  options + " })\nreturn {}", "m.lua");
  const Vec3 path[] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  Follower f;
  const bool truth = std::string(sensed) == "truth";
  for (int i = 0; i < 30 * 60 && !f.stopped; ++i) {
    Value sense = Value::make_table(), place = Value::make_table(), position = Value::make_table();
    for (const double value : {f.x, f.y, 0.0}) position.items.push_back(Value::make_number(value));
    place.set("position", position);
    place.set("x", Value::make_number(truth ? 7 : f.x));
    place.set("y", Value::make_number(f.y));
    place.set("yaw", Value::make_number(f.yaw));
    sense.set(sensed, place);
    const Value answer = sandbox.call_controller(1, sense);
    const double linear = answer.find("linear")->number, angular = answer.find("angular")->number;
    EXPECT_LE(std::abs(angular), 1 + 1e-12);
    EXPECT_LE(linear, 0.3 + 1e-12);
    f.stopped = linear == 0 && angular == 0;
    f.yaw += angular / 30;
    f.x += linear * std::cos(f.yaw) / 30, f.y += linear * std::sin(f.yaw) / 30;
    double nearest = 1e9;
    for (int k = 0; k < 3; ++k) nearest = std::min(nearest, distance_to_leg(f.x, f.y, path[k], path[k + 1]));
    f.worst = std::max(f.worst, nearest);
    f.corner = std::min(f.corner, std::hypot(f.x - 2, f.y - 1));
  }
  return f;
}

TEST(RobotFollow, StaysNearItsPathAndStopsAtTheEnd) {
  for (const char* by : {"truth", "odometry"}) {
    const Follower close = follow(std::string("lookahead = 0.2, by = \"") + by + "\"", by);
    EXPECT_TRUE(close.stopped) << by;
    EXPECT_NEAR(close.x, 0, 0.05) << by;
    EXPECT_NEAR(close.y, 1, 0.05) << by;
    EXPECT_LT(close.worst, 0.06) << by;
    EXPECT_LT(close.corner, 0.08) << by << ": no corner is left out";
  }
  const Follower far = follow("lookahead = 0.5", "truth");
  EXPECT_TRUE(far.stopped);
  EXPECT_GT(far.corner, follow("lookahead = 0.2", "truth").corner) << "it cuts corners more";
}

TEST(RobotFollow, ARobotWithoutOdometryIsAMistake) {
  LuaSandbox sandbox(1, "rubble.mission");
  sandbox.run("rubble.controller(rubble.robot.follow { path = { { 0, 0 }, { 1, 0 } }, by = \"odometry\" })\n"
              "return {}", "m.lua");
  EXPECT_THROW(sandbox.call_controller(1, Value::make_table()), InputError);
  EXPECT_NE(error_of("rubble.robot.follow { path = { { 0, 0 }, { 0, 0 } } }").find("path[2]"),
            std::string::npos);
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

}  // namespace robot_keys_test
}  // namespace rubble
