// MRPT's reactive navigator behind our interface, and the benchmark in which it drives the crawler.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/navigate/collision_counter.h"
#include "app/navigate/navigation_run.h"
#include "app/navigate/obstacle_map.h"
#include "app/navigate/pilot.h"
#include "app/pipeline/seeded_piles.h"
#include "io/mrpt/reactive_navigator.h"
#include "kernel/base/error.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace navigate_test {

using Json = nlohmann::json;

// A robot on a plane that moves exactly as it is told, among walls that it sees from everywhere.
struct Plane {
  std::vector<Vec3> points;

  void wall(double x0, double y0, double x1, double y1) {
    const double length = std::hypot(x1 - x0, y1 - y0);
    for (double d = 0; d <= length; d += 0.05)
      for (double z = 0.12; z < 0.5; z += 0.05) points.push_back({x0 + (x1 - x0) * d / length, y0 + (y1 - y0) * d / length, z});
  }
  void block(double x, double y, double half) {
    wall(x - half, y - half, x + half, y - half), wall(x + half, y - half, x + half, y + half);
    wall(x + half, y + half, x - half, y + half), wall(x - half, y + half, x - half, y - half);
  }
};

NavigatorOptions options_in(const ScratchFolder& folder) {
  NavigatorOptions options;
  options.slices = {{0.2, 0.36, 0.33}, {0.3, 0.43, 0.33}};
  options.max_speed = 0.3, options.give_up_after = 20;
  options.cache_folder = folder.path().string();
  return options;
}

struct Driven {
  NavigatorState state = NavigatorState::driving;
  double time = 0, x = 0, y = 0, yaw = 0;
  double nearest = 1e9;        // of any point to the robot's rectangle; 0: inside
  std::vector<double> twists;  // all that the navigator said
};

double gap(const NavigatorSlice& s, double x, double y) {
  return std::hypot(std::max(0.0, std::fabs(x) - s.half_length), std::max(0.0, std::fabs(y) - s.half_width));
}

// To (8, 0), for 120 s at most. blind: the navigator is not shown the points.
Driven drive(const NavigatorOptions& options, const Plane& plane, bool blind = false) {
  ReactiveNavigator navigator(options);
  navigator.set_goal(8, 0);
  Driven d;
  double linear = 0, angular = 0;
  for (int k = 0; k < 600 && d.state == NavigatorState::driving; ++k) {
    NavigatorInput input;
    input.time = d.time = 0.2 * k;
    input.x = d.x, input.y = d.y, input.yaw = d.yaw;
    const double c = std::cos(d.yaw), s = std::sin(d.yaw);
    input.velocity_x = linear * c, input.velocity_y = linear * s, input.turn_rate = angular;
    for (const Vec3& p : plane.points) {
      const Vec3 local{c * (p.x - d.x) + s * (p.y - d.y), c * (p.y - d.y) - s * (p.x - d.x), p.z};
      d.nearest = std::min(d.nearest, gap(options.slices[p.z < 0.2 ? 0 : 1], local.x, local.y));
      if (!blind) input.obstacles.push_back(Vec3f(local));
    }
    const NavigatorOutput output = navigator.step(input);
    d.state = output.state, linear = output.linear, angular = output.angular;
    d.twists.insert(d.twists.end(), {linear, angular});
    for (int i = 0; i < 20; ++i) {
      d.x += 0.01 * linear * std::cos(d.yaw), d.y += 0.01 * linear * std::sin(d.yaw), d.yaw += 0.01 * angular;
    }
  }
  return d;
}

TEST(ReactiveNavigator, DrivesStraightToAGoalInTheOpen) {
  const ScratchFolder folder;
  const Driven d = drive(options_in(folder), {});
  EXPECT_EQ(d.state, NavigatorState::arrived);
  EXPECT_NEAR(d.x, 7.7, 0.1);
  EXPECT_NEAR(d.y, 0, 0.02);
  EXPECT_NEAR(d.time, 7.7 / 0.3, 2);
}

TEST(ReactiveNavigator, DrivesBetweenWallsRoundBlocksAndTheSameEachTime) {
  const ScratchFolder folder;
  Plane plane;
  plane.block(2.5, 0.1, 0.3), plane.block(5, -0.9, 0.2);
  plane.wall(1, -1.5, 7, -1.5), plane.wall(1, 1.5, 7, 1.5);
  const Driven d = drive(options_in(folder), plane);
  EXPECT_EQ(d.state, NavigatorState::arrived) << "at " << d.x << " " << d.y;
  EXPECT_GT(d.nearest, 0) << "it drove into something";
  EXPECT_EQ(drive(options_in(folder), plane, true).nearest, 0) << "nothing was in the way";
  // Tables of arcs that were loaded give the same as those that were computed.
  EXPECT_EQ(drive(options_in(folder), plane).twists, d.twists);
  const ScratchFolder other;
  EXPECT_EQ(drive(options_in(other), plane).twists, d.twists);
}

TEST(ReactiveNavigator, GivesUpWhereItIsWalledIn) {
  const ScratchFolder folder;
  Plane plane;
  plane.block(0, 0, 1.2);
  const Driven d = drive(options_in(folder), plane);
  EXPECT_EQ(d.state, NavigatorState::gave_up);
  EXPECT_GT(d.time, 20);
  EXPECT_LT(std::hypot(d.x, d.y), 0.8);
  EXPECT_GT(d.nearest, 0);
}

TEST(ReactiveNavigator, MistakesAreNamed) {
  const auto key_of = [](const NavigatorOptions& options) -> std::string {
    try {
      ReactiveNavigator{options};
    } catch (const InputError& error) {
      return error.diagnostics().front().key;
    }
    return "none";
  };
  const ScratchFolder folder;
  NavigatorOptions options = options_in(folder);
  options.slices.clear();
  EXPECT_EQ(key_of(options), "slices");
  options = options_in(folder), options.max_speed = -1;
  EXPECT_EQ(key_of(options), "max_speed");
  options = options_in(folder), options.horizon = std::nan("");
  EXPECT_EQ(key_of(options), "horizon");
}

// It is always where the navigator was last sent to, on the way to a goal that it does not come nearer to.
TEST(Pilot, GivesUpWhereItGetsNoFurtherThoughItReachesPlacesOfItsRoute) {
  const ScratchFolder scratch;
  PilotOptions options;
  options.rules.plans = true, options.rules.goal_radius = 2.5;  // places of the route are at most 2 m ahead
  options.bounds.include({-4, -4, -0.5}), options.bounds.include({14, 4, 1.5});
  options.shape = {{0.3, 0.4, 0.3}};
  options.waypoints = {{10, 0, 0}};
  options.cache_folder = scratch.path().string();
  Pilot pilot(options);
  double gave_up = 0;
  for (int i = 0; i < 200 && gave_up == 0; ++i) {
    const double time = 0.2 * i;
    if (pilot.step({time, {0, 0, 0}, 0, {}, 0}).state == NavigatorState::gave_up) gave_up = time;
  }
  EXPECT_NEAR(gave_up, options.rules.stuck_time, 0.5);
}

TEST(ObstacleMap, HoldsCellsThatWereSeenOftenEnough) {
  Aabb bounds;
  bounds.include({-1, -1, 0}), bounds.include({1, 1, 1});
  ObstacleMap map(bounds, 0.1, 2);
  map.add({0.31, 0.42, 0.55});
  EXPECT_FALSE(map.is_occupied({0.31, 0.42, 0.55}));
  map.add({0.38, 0.48, 0.51});  // the same cell
  map.add({-0.95, 0.0, 0.95}), map.add({-0.95, 0.0, 0.95});
  map.add({5, 0, 0}), map.add({0, 0, -1});  // outside
  EXPECT_TRUE(map.is_occupied({0.35, 0.45, 0.5}));
  EXPECT_FALSE(map.is_occupied({0.45, 0.45, 0.5}));
  const std::vector<Vec3> near = map.find_around({0, 0, 0}, 0.6, 0.2, 0.8);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_NEAR(distance(near[0], {0.35, 0.45, 0.55}), 0, 1e-9);
  EXPECT_EQ(map.find_around({0, 0, 0}, 3, -1, 3).size(), 2u);
  // The same from above.
  EXPECT_EQ(map.flat_grid().size, (Cell{20, 20, 1}));
  EXPECT_EQ(map.find_columns(0, 1), (std::vector<Cell>{{0, 10, 0}, {13, 14, 0}}));
  EXPECT_EQ(map.find_columns(0.4, 0.7), (std::vector<Cell>{{13, 14, 0}}));
}

TEST(ObstacleMap, ForgetsWhatScansSeeThrough) {
  Aabb bounds;
  bounds.include({-1, -1, 0}), bounds.include({2, 1, 1});
  ObstacleMap map(bounds, 0.1, 2);
  const Vec3 sensor{-0.95, 0.05, 0.45}, block{0.55, 0.05, 0.45}, wall{1.55, 0.05, 0.45}, aside{0.55, 0.65, 0.45};
  map.add_scan(sensor, {block});
  EXPECT_FALSE(map.is_occupied(block)) << "one scan";
  map.add_scan(sensor, {block, aside});
  EXPECT_TRUE(map.is_occupied(block));
  map.add_scan(sensor, {aside, aside, aside});
  EXPECT_TRUE(map.is_occupied(block)) << "nothing was seen there";
  // Echoes behind it in the same scan: it hides what is behind only in part.
  map.add_scan(sensor, {block, wall}), map.add_scan(sensor, {block, wall});
  EXPECT_TRUE(map.is_occupied(block));
  EXPECT_TRUE(map.is_occupied(wall));
  // It is gone; what was seen long is not forgotten at once.
  map.add_scan(sensor, {wall});
  EXPECT_TRUE(map.is_occupied(block));
  for (int k = 0; k < 10; ++k) map.add_scan(sensor, {wall});
  EXPECT_FALSE(map.is_occupied(block));
  EXPECT_TRUE(map.is_occupied(wall));
  EXPECT_TRUE(map.is_occupied(aside));
  // As fast as it was at first it is there again.
  map.add_scan(sensor, {block}), map.add_scan(sensor, {block});
  EXPECT_TRUE(map.is_occupied(block));
  map.add_scan({5, 5, 5}, {{6, 5, 5}, {5, 5, 5}});  // outside, and an echo at the sensor
}

// Against a wall whose near side is the plane x = 0.5 and whose top is at `top`.
RobotContact touch(double z, double force = 10, const Vec3& normal = {-1, 0, 0}) {
  RobotContact contact;
  contact.link = 1, contact.piece = 3, contact.force = force;
  contact.point = {0.5, 0.1, z}, contact.normal = normal;
  return contact;
}

int count_of(const RobotContact& contact, double top) {
  CollisionCounter counter(5, 0.1, [top](const Vec3& p) { return p.x > 0.5 && p.z < top; });
  counter.note({contact}, {0, 0, 0});
  return counter.count();
}

TEST(CollisionCounter, CountsWhatIsHigherThanAStepWhereverItIsTouched) {
  EXPECT_EQ(count_of(touch(0.2), 0.5), 1);
  EXPECT_EQ(count_of(touch(0.089), 0.5), 1) << "a track meets a wall at the height of its axle";
  EXPECT_EQ(count_of(touch(0.089), 0.09), 0) << "it is driven over";
  EXPECT_EQ(count_of(touch(0.02, 10, {0, 0, 1}), 0.5), 0) << "the robot stands on it";
  EXPECT_EQ(count_of(touch(0.2, 0), 0.5), 0) << "it does not press";
  RobotContact other = touch(0.2);
  other.piece = -1;
  EXPECT_EQ(count_of(other, 0.5), 0) << "the ground";
  other.piece = 5;
  EXPECT_EQ(count_of(other, 0.5), 0) << "the robot itself";
}

TEST(CollisionCounter, APressureThatLastsIsOneCollision) {
  CollisionCounter counter(5, 0.1, [](const Vec3& p) { return p.x > 0.5; });
  const auto play = [&](bool touches) {
    counter.begin_period();
    for (int step = 0; step < 3; ++step)
      counter.note(touches && step > 0 ? std::vector<RobotContact>{touch(0.05)} : std::vector<RobotContact>{}, {0, 0, 0});
    return counter.count();
  };
  EXPECT_EQ(play(false), 0);
  EXPECT_EQ(play(true), 1);
  EXPECT_EQ(play(true), 1);
  EXPECT_EQ(play(false), 1);
  EXPECT_EQ(play(true), 2);
}

// Under the slab is a void that is open at both ends, and a block in it.
const char* const kMission = R"(
return rubble.mission {
  seed = 2,
  pile = rubble.join(
    rubble.collapse.lean_to { length = 6, width = 4, height = rubble.random("m"):uniform(2, 2.2), debris = { layers = 0 } },
    rubble.collapse.free { pieces = { { box = { 0.3, 0.3, 0.3 }, position = { 1.4, 0, 0.151 } } }, debris = { layers = 0 } }),
  camera = { width = 64, height = 48 },
  trajectory = { rate_hz = 5, waypoints = { { t = 0, position = { -5, 0, 2 }, look_at = { 0, 0, 0.5 } },
                                            { t = 0.4, position = { -5, 0.2, 2 }, look_at = { 0, 0, 0.5 } } } },
})";

class NavigationBench : public ::testing::Test {
 protected:
  struct Drives {
    Outcome outcome;
    std::string missions, way_of_2;  // of its files
  };

  void SetUp() override { write_file(folder_ / "m.lua", kMission); }
  static Outcome navigate_in(const ScratchFolder& folder, const std::string& options) {
    return run_rubble("bench navigate " + (folder / "m.lua") + " --quiet --force --out " + (folder / "out") + " " + options);
  }
  Outcome navigate(const std::string& options) const { return navigate_in(folder_, options); }
  // Driven once for all tests.
  static const Drives& seeds_2_and_3() {
    static const Drives once = [] {
      const ScratchFolder folder;
      write_file(folder / "m.lua", kMission);
      const Outcome both = navigate_in(folder, "--seeds 2..3 --json");
      return Drives{both, read_file(folder / "out/missions.csv"), read_file(folder / "out/ways/2.csv")};
    }();
    return once;
  }
  ScratchFolder folder_;
};

TEST_F(NavigationBench, TheCrawlerDrivesThroughTheVoidEachTimeTheSame) {
  const Outcome& both = seeds_2_and_3().outcome;
  ASSERT_EQ(both.exit_code, 0) << both.err;
  const Json table = Json::parse(both.out, nullptr, false);
  ASSERT_TRUE(table.is_object()) << both.out;
  const Json row = table["datasets"][0];
  EXPECT_EQ(row["missions"], 2);
  EXPECT_EQ(row["arrived_share"], 1);
  EXPECT_GT(row["inside_m"], 2.5);
  EXPECT_GT(row["path_m"], 3);
  EXPECT_LT(row["time_s"], 60);
  EXPECT_TRUE(row.contains("deadlines_missed"));
  std::istringstream lines(seeds_2_and_3().missions);
  std::string head, second, third;
  std::getline(lines, head), std::getline(lines, second), std::getline(lines, third);
  EXPECT_NE(second.substr(0, 16), third.substr(0, 16)) << "two piles, one drive";
  // Alone, without the tables of arcs that the other left, and on two threads: to the bit.
  ASSERT_EQ(navigate("--seeds 3 --threads 2").exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "out/missions.csv"), head + "\n" + third + "\n");
  EXPECT_EQ(read_file(folder_ / "out/table.csv").find("deadlines"), std::string::npos) << "the clock is in a file";
}

// A beam lies across the void, too high to be driven over. A robot that sees turns away from it; one that does not drives
// into it.
TEST_F(NavigationBench, ARobotThatDoesNotSeeCollides) {
  write_file(folder_ / "m.lua", R"(
return rubble.mission {
  pile = rubble.join(
    rubble.collapse.lean_to { length = 6, width = 4, height = 2.1, debris = { layers = 0 } },
    rubble.collapse.free { pieces = { { box = { 4.4, 0.3, 0.45 }, position = { 2.3, 0, 0.226 }, fixed = true } },
                           debris = { layers = 0 } }),
})");
  RunRequest mission;
  mission.mission = folder_ / "m.lua";
  for_each_pile({mission, {2}, {}, [](const std::string&) {}}, [](const ResolvedMission&) {}, [&](const SeededPile& pile) {
    NavigationRules rules;
    rules.time_limit = 25;
    const NavigationScore sees = rubble::navigate(NavigationWorld(pile.mission, pile.state, rules, 2), 2, folder_.path());
    rules.voxel = 100;  // one cell is all of its map
    const NavigationScore blind = rubble::navigate(NavigationWorld(pile.mission, pile.state, rules, 2), 2, folder_.path());
    EXPECT_EQ(sees.collisions, 0);
    EXPECT_GT(blind.collisions, 0);
  });
}

// In this pile the navigator alone drives to and fro before two blocks until it gives up.
TEST_F(NavigationBench, WithAGlobalPlannerItArrivesWhereTheNavigatorAloneDoesNot) {
  const auto drive = [&](const std::string& options) {
    const Outcome outcome = run_rubble("bench navigate scripts/navigate.lua --seeds 5 --quiet --json --force --out " + (folder_ / "out") + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false)["datasets"][0];
  };
  const Json alone = drive("");
  EXPECT_EQ(alone["arrived_share"], 0);
  EXPECT_EQ(alone["plans"], 0);
  const Json planned = drive(" --planner ompl");
  const std::string way = read_file(folder_ / "out/ways/5.csv");
  EXPECT_EQ(planned["arrived_share"], 1);
  EXPECT_GE(planned["plans"], 1);
  EXPECT_LT(planned["time_s"], alone["time_s"]);
  EXPECT_EQ(way.find("time_s,x,y,yaw,target_x,target_y,goal_x,goal_y\n0.0,"), 0u) << way.substr(0, 200);
  EXPECT_EQ(double(std::count(way.begin(), way.end(), '\n')), planned["periods"].get<double>() + 1);
}

TEST_F(NavigationBench, TheTableIsWrittenIntoADocument) {
  const std::string document = folder_ / "d.md";
  write_file(document, "before\n<!-- begin navigate -->\nold\n<!-- end navigate -->\nafter\n");
  const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && /usr/bin/python3 tools/navigate_table.py --seeds 2 --mission " +
                              (folder_ / "m.lua") + " --out " + (folder_ / "t") + " --program " RUBBLE_PROGRAM " " + document;
  ASSERT_EQ(std::system((command + " 2>/dev/null").c_str()), 0);
  const std::string text = read_file(document);
  EXPECT_EQ(text.find("before\n<!-- begin navigate -->\n| | navigator alone | with a planner |\n|---|---|---|\n| missions | 1 | 1 |\n| arrived | 1.00 (95 %: "), 0u)
      << text;
  EXPECT_NE(text.find("<!-- end navigate -->\nafter\n"), std::string::npos) << text;
}

// As ros1_navigator drives it, and with the robot where the benchmark puts it.
TEST_F(NavigationBench, WritesMissionsThatAreDrivenOverTopics) {
  ASSERT_EQ(navigate("--seeds 2 --missions-only").exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "out/missions.csv"), "") << "nothing was driven";
  const Json written = Json::parse(read_file(folder_ / "out/missions/2.json"), nullptr, false);
  ASSERT_TRUE(written.is_object());
  const Outcome check = run_rubble("check " + (folder_ / "out/missions/2.lua"));
  ASSERT_EQ(check.exit_code, 0) << check.err;
  const Json scenario = Json::parse(check.out, nullptr, false);
  const Json robot = scenario["robots"][0];
  EXPECT_EQ(scenario["seed"], 2);
  EXPECT_EQ(scenario["trajectory"]["ride"]["robot"], robot["name"]);
  // Where the goals are in the world: the last one where the benchmark drives to.
  std::istringstream way(seeds_2_and_3().way_of_2);
  std::string line;
  std::getline(way, line), std::getline(way, line);
  std::vector<double> row;
  std::istringstream cells(line);
  for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  ASSERT_EQ(row.size(), 8u) << line;
  EXPECT_NEAR(robot["position"][0], row[1], 0.02);
  EXPECT_NEAR(robot["position"][1], row[2], 0.02);
  const double yaw = robot["rpy_deg"][2].get<double>() * 3.14159265358979 / 180;
  EXPECT_NEAR(yaw, row[3], 0.01);
  const Json goal = written["goals"].back();
  const double ahead = goal[0], left = goal[1];
  EXPECT_NEAR(row[1] + ahead * std::cos(yaw) - left * std::sin(yaw), row[6], 0.03);
  EXPECT_NEAR(row[2] + ahead * std::sin(yaw) + left * std::cos(yaw), row[7], 0.03);
  EXPECT_GE(written["goals"].size(), 2u);
}

TEST_F(NavigationBench, MistakesAreNamed) {
  const auto expect = [&](const std::string& options, const std::string& part) {
    const Outcome outcome = navigate(options);
    EXPECT_EQ(outcome.exit_code, 1) << options;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " is not in\n" << outcome.err;
  };
  expect("--seeds two", "--seeds");
  expect("--planner clever", "--planner: no such planner");
  write_file(folder_ / "m.lua", "return rubble.mission { pile = { layers = 1, pieces_per_layer = 5 } }");
  expect("--seeds 2", "no pile of these seeds has a void for the crawler");
}

}  // namespace navigate_test
}  // namespace rubble::testing
