// A mission that is served: the services of simulation_interfaces, and what robots obey.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "io/ros/ros_messages.h"
#include "tests/app/served.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace serve_test {

using Names = std::vector<std::string>;
enum : int { kUnsupported = 0, kOk = 1, kNotFound = 2, kIncorrectState = 3, kFailed = 4 };

const char* const kYard = R"(return rubble.mission {
  seed = 3, start_ns = 5000000000,
  pile = { layers = 1, pieces_per_layer = 4, mix = { { asset = "brick" } }, spawn_position = { 4, 0, 1 }, spawn_bounds = { 1, 1, 1 },
           placed = { { box = { 0.2, 4, 1 }, position = { 6, 0, 0.5 } } } },
  robots = { { name = "tank", model = "crawler", position = { 0, 0, 0.001 } } },
  batteries = { pack = { ride = { robot = "tank" }, rate_hz = 20 } },
  camera = { width = 32, height = 24 },
})";

std::string twist(double linear) {
  ros::Wire wire(ros::Version::ros2);
  for (const double value : {linear, 0.0, 0.0, 0.0, 0.0, 0.0}) wire.number(value);
  return wire.take();
}

std::string joint_command(const std::string& joint, double position) {
  return ros::joint_state(ros::Version::ros2, {0, 0, ""}, {joint}, {position}, {}, {});
}

struct Joints {
  Names names;
  std::vector<double> positions;
  double of(const std::string& name) const {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return positions[i];
    return std::numeric_limits<double>::quiet_NaN();
  }
};

Joints last_joints(ServedMission& served) {
  const Names messages = served.network().take_messages("/joint_states");
  Joints joints;
  if (messages.empty()) return joints;
  WireCursor cursor("joints", ros::Version::ros2, messages.back());
  cursor.header();
  for (std::size_t i = cursor.count(4); i > 0; --i) joints.names.push_back(cursor.text());
  joints.positions = cursor.list<double>();
  return joints;
}

int reset(ServedMission& served, std::uint8_t scope = 0) {
  return served.ask("reset_simulation", [&](ros::Wire& w) { w.number(scope); }).result;
}

int set_simulation_state(ServedMission& served, std::uint8_t state) {
  return served.ask("set_simulation_state", [&](ros::Wire& w) { w.number(state); }).result;
}

int simulation_state(ServedMission& served) { return served.ask("get_simulation_state").rest().number<std::uint8_t>(); }

TEST(Serve, ThirteenServicesSayWhatThereIs) {
  ServedMission served(kYard);
  EXPECT_EQ(served.network().services().size(), 13u);
  EXPECT_EQ(simulation_state(served), 2);
  Answer features = served.ask("get_simulator_features");
  std::set<int> known;
  for (std::size_t i = features.rest().count(2); i > 0; --i) known.insert(features.rest().number<std::uint16_t>());
  EXPECT_EQ(known, (std::set<int>{0, 1, 4, 6, 8, 10, 11, 12, 14, 20, 24, 25, 26, 31, 32}));
  EXPECT_EQ(features.texts(), Names{"urdf"});

  EXPECT_EQ(served.entities().texts().size(), 6u);
  EXPECT_EQ(served.entities("", {1}).texts(), Names{"tank"});
  EXPECT_EQ(served.entities("", {}, {"brick"}).texts().size(), 4u);
  const Names walls = served.entities("", {5}).texts();
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(served.entities("^ta").texts(), Names{"tank"});
  EXPECT_EQ(served.entities("(").result, kFailed);
  const auto sphere = [](ros::Wire& w) {
    w.number(std::uint8_t{3}), w.count(2);
    for (const double value : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0}) w.number(value);
  };
  EXPECT_EQ(served.entities("", {}, {}, sphere).texts(), Names{"tank"});
  const auto hull = [](ros::Wire& w) { w.number(std::uint8_t{2}), w.count(0); };
  EXPECT_EQ(served.entities("", {}, {}, hull).result, kUnsupported);

  Answer info = served.ask("get_entity_info", [](ros::Wire& w) { w.text("tank"); });
  EXPECT_EQ(info.rest().number<std::uint8_t>(), 1);
  EXPECT_EQ(info.rest().text(), "crawler");
  EXPECT_EQ(info.texts(), (Names{"robot", "crawler"}));
  EXPECT_EQ(served.ask("get_entity_info", [](ros::Wire& w) { w.text("nobody"); }).result, kNotFound);
  EXPECT_EQ(served.state("nobody").result, kNotFound);

  Answer states = served.ask("get_entities_states", [](ros::Wire& w) {
    w.text("^tank$"), w.count(0), w.count(0), w.number(std::uint8_t{0}), w.number(std::uint8_t{0}), w.count(0);
  });
  EXPECT_EQ(states.texts(), Names{"tank"});
  EXPECT_EQ(states.rest().count(1), 1u);
  EXPECT_EQ(states.rest().header().frame, "world");
}

TEST(Serve, StepsAreMadeAndWhatIsLiftedFalls) {
  ServedMission served(kYard);
  EXPECT_EQ(served.step(24), kOk);
  EXPECT_EQ(served.state("tank").stamp_ns, 5'100'000'000);
  const std::string brick = served.entities("", {}, {"brick"}).texts().front();
  EXPECT_EQ(served.set_state(brick, {4, 3, 2}).result, kOk);
  EXPECT_EQ(served.step(48), kOk);
  const ServedMission::State fallen = served.state(brick);  // for 0.2 s
  EXPECT_NEAR(fallen.pose.translation.z, 2 - 9.81 * 0.02, 0.01);
  EXPECT_NEAR(fallen.linear.z, -9.81 * 0.2, 0.05);
  EXPECT_EQ(served.set_state(brick, {0, 0, 1}, Quat{0, 0, 0, 0}).result, 101) << "no rotation";
  EXPECT_EQ(served.set_state("nobody", {}).result, kNotFound);
  const std::string wall = served.entities("", {5}).texts().front();
  EXPECT_EQ(served.set_state(wall, {0, 0, 3}).result, kFailed) << "it is fixed";
  EXPECT_EQ(served.set_state("tank", {-1, 2, 0.1}).result, kOk);
  EXPECT_NEAR(served.state("tank").pose.translation.y, 2, 1e-9);

  EXPECT_EQ(reset(served, 1), kUnsupported) << "time alone";
  EXPECT_EQ(reset(served), kOk);
  EXPECT_EQ(served.state("tank").stamp_ns, 5'000'000'000);
  EXPECT_NEAR(served.state("tank").pose.translation.y, 0, 1e-6);
}

TEST(Serve, RobotsComeAndGoBeforeTheFirstStep) {
  ServedMission served(kYard);
  Answer spawnables = served.ask("get_spawnables", [](ros::Wire& w) { w.count(0); });
  EXPECT_GE(spawnables.rest().count(4), 4u);
  EXPECT_EQ(spawnables.rest().text().rfind("rubble://", 0), 0u);
  EXPECT_EQ(served.ask("get_spawnables", [](ros::Wire& w) { w.count(1), w.text("index"); }).result, kUnsupported);

  EXPECT_EQ(served.spawn("scout", "rubble://boat", {-2, 0, 0.01}).result, 103);
  EXPECT_EQ(served.spawn("scout", "", {-2, 0, 0.01}).result, 104);
  EXPECT_EQ(served.spawn("7up", "rubble://rover", {-2, 0, 0.01}).result, 102);
  EXPECT_EQ(served.spawn("tank", "rubble://rover", {-2, 0, 0.01}).result, 101);
  EXPECT_EQ(served.spawn("scout", "rubble://rover", {6, 0, 0.5}).result, kFailed) << "in the wall";
  Answer spawned = served.spawn("tank", "rubble://rover", {-2, 0, 0.01}, true);
  EXPECT_EQ(spawned.result, kOk) << spawned.message;
  EXPECT_EQ(spawned.rest().text(), "tank_2");
  EXPECT_NEAR(served.state("tank_2").pose.translation.x, -2, 1e-9);

  EXPECT_EQ(served.step(1), kOk);
  EXPECT_EQ(served.spawn("late", "rubble://rover", {-4, 0, 0.01}).result, kIncorrectState);
  EXPECT_EQ(reset(served, 3), kOk);
  EXPECT_EQ(served.state("tank_2").result, kOk) << "it was kept";
  EXPECT_EQ(reset(served), kOk);
  EXPECT_EQ(served.state("tank_2").result, kNotFound);

  EXPECT_EQ(served.spawn("scout", "rubble://rover", {-2, 0, 0.01}).result, kOk);
  const auto remove = [&](const std::string& name) {
    return served.ask("delete_entity", [&](ros::Wire& w) { w.text(name); }).result;
  };
  EXPECT_EQ(remove("nobody"), kNotFound);
  EXPECT_EQ(remove(served.entities("", {5}).texts().front()), kFailed) << "a piece";
  EXPECT_EQ(remove("scout"), kOk);
  EXPECT_EQ(served.state("scout").result, kNotFound);
  EXPECT_EQ(remove("tank"), kFailed) << "the last robot, and its battery rides on it";
  EXPECT_EQ(served.step(1), kOk) << "it goes on";
}

TEST(Serve, ARobotComesFromAFile) {
  const ScratchFolder scratch;
  const std::string block = "<link name='base_link'><inertial><mass value='2'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' "
                            "iyz='0'/></inertial><collision><geometry><box size='0.2 0.2 0.2'/></geometry></collision></link>";
  write_file(scratch / "block.urdf", "<robot name='block'>" + block + "</robot>");
  write_file(scratch / "broken.urdf", "<robot name='block'>" + block);
  ServedMission served(kYard);
  EXPECT_EQ(served.spawn("block", "file://" + (scratch / "none.urdf"), {-2, 0, 0.5}).result, 106);
  EXPECT_EQ(served.spawn("block", "file://" + (scratch / "broken.urdf"), {-2, 0, 0.5}).result, 106);
  EXPECT_EQ(served.spawn("block", scratch / "block.sdf", {-2, 0, 0.5}).result, 103);
  const Answer spawned = served.spawn("block", "file://" + (scratch / "block.urdf"), {-2, 0, 0.5});
  EXPECT_EQ(spawned.result, kOk) << spawned.message;
  EXPECT_NEAR(served.state("block").pose.translation.z, 0.5, 1e-9);
  EXPECT_EQ(served.step(48), kOk);
  EXPECT_NEAR(served.state("block").pose.translation.z, 0.5 - 9.81 * 0.02, 0.01);
}

TEST(Serve, RobotsObeyTopicsUntilTheirDriverIsGone) {
  ServedMission served(kYard);
  served.network().send("/cmd_vel", twist(0.3));
  served.network().send("/joint_commands", joint_command("front_left_flipper_joint", 0.4));
  EXPECT_EQ(served.step(120), kOk);
  const double x = served.state("tank").pose.translation.x;
  EXPECT_GT(x, 0.08);
  EXPECT_EQ(served.step(360), kOk);
  const double stopped = served.state("tank").pose.translation.x;
  EXPECT_LT(stopped, x + 0.12) << "the twist ends after half a second";
  EXPECT_EQ(served.step(240), kOk);
  EXPECT_NEAR(served.state("tank").pose.translation.x, stopped, 0.01);
  const Joints joints = last_joints(served);
  EXPECT_NEAR(joints.of("front_left_flipper_joint"), 0.4, 0.05) << ::testing::PrintToString(joints.names);

  // Its battery gave more while it drove; it began full.
  const Names readings = served.network().take_messages("/battery_state");
  ASSERT_GT(readings.size(), 40u);
  const auto current_of = [](const std::string& message) {
    WireCursor cursor("battery", ros::Version::ros2, message);
    cursor.header();
    const float voltage = cursor.number<float>(), temperature = cursor.number<float>();
    EXPECT_GT(voltage, 20);
    EXPECT_TRUE(std::isnan(temperature));
    return cursor.number<float>();
  };
  EXPECT_LT(current_of(readings[5]), current_of(readings.back()) - 0.05f) << "it is negative";
  EXPECT_LT(current_of(readings.back()), -0.5f);

  served.network().send("/joint_commands", joint_command("no_such_joint", 1));
  served.network().send("/joint_commands", joint_command("front_left_flipper_joint", std::nan("")));
  served.network().send("/cmd_vel", std::string("\0\1\0\0short", 9));
  served.network().send("/joint_trajectory", std::string("\0\1\0\0\xff\xff\xff\xff\xff\xff\xff\xff", 12));
  EXPECT_EQ(served.step(2), kOk);
  EXPECT_IN("no_such_joint", served.said());
  EXPECT_IN("/cmd_vel: what came is no geometry_msgs/Twist", served.said());
  EXPECT_IN("/joint_trajectory: what came is no trajectory_msgs/JointTrajectory", served.said());
  EXPECT_NEAR(last_joints(served).of("front_left_flipper_joint"), 0.4, 0.05);
}

TEST(Serve, ItPlaysPausesAndStops) {
  ServedMission served(kYard);
  EXPECT_EQ(set_simulation_state(served, 2), 101) << "it is paused already";
  EXPECT_EQ(set_simulation_state(served, 1), kOk);
  EXPECT_EQ(served.step(1), kIncorrectState) << "it plays";
  const auto began = served.state("tank").stamp_ns;
  for (int i = 0; i < 1000 && served.state("tank").stamp_ns == began; ++i) {
  }
  EXPECT_GT(served.state("tank").stamp_ns, began);
  EXPECT_EQ(set_simulation_state(served, 2), kOk);
  const auto paused = served.state("tank").stamp_ns;
  EXPECT_EQ(served.state("tank").stamp_ns, paused);
  EXPECT_EQ(set_simulation_state(served, 0), kOk);
  EXPECT_EQ(served.state("tank").stamp_ns, 5'000'000'000);
  EXPECT_EQ(set_simulation_state(served, 2), 103) << "from stopped to paused";
  EXPECT_EQ(set_simulation_state(served, 5), kUnsupported);
}

TEST(Serve, ManyStepsEndWhenAnotherClientSaysSo) {
  ServedMission served(kYard);
  served.network().request("/step_simulation", make_request([](ros::Wire& w) { w.number(std::uint64_t{1} << 60); }));
  for (int i = 0; i < 1000 && served.state("tank").stamp_ns == 5'000'000'000; ++i) {
  }
  EXPECT_EQ(reset(served), kOk);
  Answer ended(served.network().wait_for_reply("/step_simulation"));
  EXPECT_EQ(ended.rest().number<std::uint8_t>(), kFailed);
  EXPECT_IN("ended after ", ended.rest().text());
  EXPECT_EQ(served.state("tank").stamp_ns, 5'000'000'000);
  EXPECT_EQ(simulation_state(served), 2);
}

// Cut short, too long, or with counts that cannot be: answered with an error and all fields, and nothing is done.
TEST(Serve, DamagedRequestsAreAnsweredWithAnError) {
  ServedMission served(kYard);
  const std::vector<std::pair<std::string, ServedMission::Body>> requests{
      {"set_simulation_state", [](ros::Wire& w) { w.number(std::uint8_t{1}); }},
      {"reset_simulation", [](ros::Wire& w) { w.number(std::uint8_t{0}); }},
      {"step_simulation", [](ros::Wire& w) { w.number(std::uint64_t{1}); }},
      {"get_entities", [](ros::Wire& w) { w.text(""), w.count(0), w.count(0), w.number(std::uint16_t{0}), w.count(0); }},
      {"get_entities_states", [](ros::Wire& w) { w.text(""), w.count(0), w.count(0), w.number(std::uint16_t{0}), w.count(0); }},
      {"get_entity_state", [](ros::Wire& w) { w.text("tank"); }},
      {"set_entity_state", [](ros::Wire& w) {
         w.text("tank"), w.time(0), w.text("");
         for (int i = 0; i < 19; ++i) w.number(i == 6 ? 1.0 : 0.0);
         w.boolean(true), w.boolean(true), w.boolean(false);
       }},
      {"get_entity_info", [](ros::Wire& w) { w.text("tank"); }},
      {"get_spawnables", [](ros::Wire& w) { w.count(0); }},
      {"spawn_entity", [](ros::Wire& w) {
         w.text("scout"), w.boolean(false), w.text("rubble://rover"), w.text(""), w.text(""), w.time(0), w.text("");
         for (const double value : {-3.0, 0.0, 0.01, 0.0, 0.0, 0.0, 1.0}) w.number(value);
       }},
      {"delete_entity", [](ros::Wire& w) { w.text("tank"); }},
  };
  const std::size_t head = make_request([](ros::Wire&) {}).size();
  for (const auto& [name, body] : requests) {
    const std::string whole = make_request(body);
    std::vector<std::string> damaged{whole + std::string(8, '\1')};
    for (std::size_t size = head; size < whole.size(); size += 5) damaged.push_back(whole.substr(0, size));
    if (whole.size() >= head + 4) damaged.push_back(whole.substr(0, head) + "\xff\xff\xff\xff" + whole.substr(head + 4));
    if (name == "step_simulation") damaged.pop_back();  // a number of steps
    for (const std::string& bytes : damaged) {
      Answer answer(served.ask_bytes(name, bytes));
      EXPECT_EQ(answer.rest().number<std::uint8_t>(), kFailed) << name << ", " << bytes.size() << " of " << whole.size();
      EXPECT_IN("what came is no", answer.rest().text());
      if (name == "get_entity_state") {
        EXPECT_EQ(answer.rest().header().frame, "");
        EXPECT_EQ(answer.rest().pose().rotation.w, 1);
      }
      const bool listed = name == "get_entities" || name == "get_spawnables";
      EXPECT_EQ(listed ? answer.rest().count(4) : 0, 0u);
      EXPECT_EQ(name == "spawn_entity" ? answer.rest().text() : "", "");
    }
  }
  for (const std::string name : {"get_simulation_state", "step_simulation"})
    served.network().request("/" + name, std::string("\0\1\0\0too short", 13));
  EXPECT_EQ(served.step(1), kOk);
  EXPECT_IN("step_simulation: what came is no StepSimulation", served.said());
  EXPECT_EQ(served.state("tank").stamp_ns, 5'000'000'000 + 4'166'667);
}

TEST(Serve, ControllersOfTheScriptGoOn) {
  ServedMission served(R"(return rubble.mission {
    seed = 3, pile = { layers = 0 },
    robots = { rubble.robot.rover { name = "own", position = { 0, 0, 0.001 }, control = function() return { linear = 0.3 } end } },
    camera = { width = 32, height = 24 },
  })");
  EXPECT_EQ(served.step(240), kOk);
  EXPECT_GT(served.state("own").pose.translation.x, 0.15);
  EXPECT_EQ(reset(served), kOk);
  EXPECT_EQ(served.step(240), kOk);
  EXPECT_GT(served.state("own").pose.translation.x, 0.15);
}

}  // namespace serve_test
}  // namespace rubble::testing
