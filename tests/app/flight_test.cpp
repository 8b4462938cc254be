// Flights over settled piles: what is refused, what is avoided, and which voids are found, against
// scenes whose answers are known.
#include "app/planning/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/settled_mission.h"
#include "tests/scripting/dead_reckoning.h"

namespace rubble::testing {
namespace flight_test {

FlightPlan plan(const SettledMission& m) {
  PileSurvey survey(m.assets, m.state, 1);
  return resolve_flight(m.mission.scenario, survey);
}

std::string plan_error(const SettledMission& m) {
  try {
    plan(m);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A wall across the way with a square window of `opening`, its middle 1.2 m above the ground; closed
// rooms are made of the same.
std::string window_wall(double x, double opening, double y = 0) {
  char text[600];
  const double low = 1.2 - opening / 2, high = 1.2 + opening / 2, side = opening / 2;
  std::snprintf(text, sizeof text,
                "rubble.wall { x0 = %g, x1 = %g, width = 6, height = %g }, "
                "rubble.wall { x0 = %g, x1 = %g, width = 6, bottom = %g, height = 3 }, "
                "rubble.wall { x0 = %g, x1 = %g, width = %g, y = %g, bottom = %g, height = %g }, "
                "rubble.wall { x0 = %g, x1 = %g, width = %g, y = %g, bottom = %g, height = %g }, ",
                x, x + 0.2, low, x, x + 0.2, high, x, x + 0.2, 3 - side + y, -(3 + side - y) / 2, low,
                high, x, x + 0.2, 3 - side - y, (3 + side + y) / 2, low, high);
  return text;
}

SettledMission scene(const std::string& placed, const std::string& trajectory) {
  return settle_text("return rubble.mission { pile = { layers = 0, placed = { " + placed +
                     " } }, trajectory = { rate_hz = 20, " + trajectory + " } }");
}

// A closed box of 6 x 6 x 3 m about a window at x = 0 and one at x = 2.
std::string tunnel(double first, double second) {
  return window_wall(0, first) + window_wall(2, second, 1) +
         "rubble.wall { x0 = 0, x1 = 4, width = 0.2, y = -2.9, height = 3 }, "
         "rubble.wall { x0 = 0, x1 = 4, width = 0.2, y = 2.9, height = 3 }, "
         "rubble.wall { x0 = 0, x1 = 4.2, width = 6, bottom = 3, height = 3.2 }, "
         "rubble.wall { x0 = 4, x1 = 4.2, width = 6, height = 3 }";
}

TEST(Refuse, NamesTimePlaceAndPieceOfTheFirstContact) {
  const SettledMission m = scene(
      "{ box = { 1, 1, 2 }, position = { 0, 0, 1 } }",
      "plan = 'refuse', radius = 0.3, interpolation = 'linear', waypoints = { { position = { -5, 0, 1 } }, "
      "{ t = 10, position = { 5, 0, 1 } } }");
  const std::string error = plan_error(m);
  // The sphere meets the worn face at x = -0.5 when its centre is 0.3 m before it: after 4.2 s.
  EXPECT_NE(error.find("trajectory.plan: the camera's body touches something"), std::string::npos) << error;
  EXPECT_NE(error.find(" at 4.2"), std::string::npos) << error;
  EXPECT_NE(error.find("{-0.80, 0.00, 1.00}"), std::string::npos) << error;
  EXPECT_NE(error.find("box 1x1x2 reinforced_concrete, piece 0"), std::string::npos) << error;
}

TEST(Refuse, LetsACloseShavePass) {
  const char* const kPath =
      "plan = 'refuse', radius = %g, waypoints = { { position = { -5, 0, 2.35 } }, { t = 10, position = { 5, 0, 2.35 } } }";
  char near_miss[300], hit[300];
  std::snprintf(near_miss, sizeof near_miss, kPath, 0.34);
  std::snprintf(hit, sizeof hit, kPath, 0.36);
  EXPECT_EQ(plan_error(scene("{ box = { 1, 1, 2 }, position = { 0, 0, 1 } }", near_miss)), "");
  EXPECT_NE(plan_error(scene("{ box = { 1, 1, 2 }, position = { 0, 0, 1 } }", hit)), "");
}

TEST(Refuse, TheGroundCounts) {
  const std::string error = plan_error(scene(
      "{ box = { 1, 1, 2 }, position = { 9, 9, 1 } }",
      "plan = 'refuse', radius = 0.3, waypoints = { { position = { 0, 0, 1 } }, { t = 1, position = { 1, 0, 0.1 } } }"));
  EXPECT_NE(error.find("the ground"), std::string::npos) << error;
}

// How often planning told how far the free space was.
int count_reports(const std::string& goal) {
  const SettledMission m =
      scene("{ box = { 1, 1, 2 }, position = { 0, 0, 1 } }",
            "plan = 'avoid', radius = 0.3, waypoints = { { position = { -3, 0, 1 } }, { position = " + goal + " } }");
  int reports = 0;
  PileSurvey survey(m.assets, m.state, 1);
  resolve_flight(m.mission.scenario, survey, [&](double, const std::string&) { ++reports; });
  return reports;
}

TEST(Avoid, MakesTheFreeSpaceOnlyWhereNoStraightLegWillDo) {
  EXPECT_EQ(count_reports("{ -3, 4, 1 }"), 0);
  EXPECT_GT(count_reports("{ 3, 0, 1 }"), 0);
}

// A way that is in the cache is not searched again, and is the same to the bit, whatever the frame rate.
TEST(FlightCache, KeepsAWayUnderAllThatItFollowsFrom) {
  const std::string folder = ::testing::TempDir() + "flight_cache";
  std::filesystem::remove_all(folder);
  const DiskCache cache(folder);
  int reports = 0;
  const auto plan_kept = [&](const SettledMission& m) {
    reports = 0;
    PileSurvey survey(m.assets, m.state, 1);
    return resolve_flight(m.mission.scenario, survey, [&](double, const std::string&) { ++reports; }, cache);
  };
  const auto way = [](const std::string& goal, const std::string& size, const std::string& more) {
    return scene("{ box = { 1, 1, " + size + " }, position = { 0, 0, 1 } }",
                 "plan = 'avoid', radius = 0.3, " + more + "waypoints = { { position = { -3, 0, 1 } }, { position = " + goal + " } }");
  };
  const SettledMission m = way("{ 3, 0, 1 }", "2", "");
  const FlightPlan first = plan_kept(m);
  EXPECT_GT(reports, 0);
  const FlightPlan again = plan_kept(m);
  EXPECT_EQ(reports, 0);
  EXPECT_EQ(again.json, first.json);
  EXPECT_EQ(again.summary, first.summary);
  ASSERT_EQ(again.poses.size(), first.poses.size());
  for (std::size_t i = 0; i < first.poses.size(); ++i) {
    EXPECT_EQ(again.poses[i].stamp_ns, first.poses[i].stamp_ns);
    EXPECT_TRUE(again.poses[i].world_from_camera.translation == first.poses[i].world_from_camera.translation) << i;
    EXPECT_TRUE(again.poses[i].world_from_camera.rotation == first.poses[i].world_from_camera.rotation) << i;
  }
  plan_kept(way("{ 3, 0, 1 }", "2", "smoothing = 0.05, max_speed = 0.3, "));  // come after the search
  EXPECT_EQ(reports, 0);
  plan_kept(way("{ 3, 0.5, 1 }", "2", ""));
  EXPECT_GT(reports, 0);
  plan_kept(way("{ 3, 0, 1 }", "1.9", ""));  // another pile
  EXPECT_GT(reports, 0);
}

TEST(Avoid, FindsTheWayThroughTwoWindows) {
  const SettledMission m = scene(tunnel(0.9, 0.9),
                                 "plan = 'avoid', radius = 0.3, speed = 1, waypoints = { "
                                 "{ position = { -3, 0, 1.2 } }, { position = { 3.2, 1, 1.2 } } }");
  const FlightPlan flight = plan(m);
  const PileQueries queries = m.queries();
  for (const CameraPose& pose : flight.poses)
    EXPECT_GE(queries.clearance(pose.world_from_camera.translation), 0.3 - 0.001);
  EXPECT_NEAR(distance(flight.poses.front().world_from_camera.translation, {-3, 0, 1.2}), 0, 1e-9);
  EXPECT_NEAR(distance(flight.poses.back().world_from_camera.translation, {3.2, 1, 1.2}), 0, 0.05) << "at 1 m/s, 20 Hz";
  const auto report = nlohmann::json::parse(flight.json);
  EXPECT_GT(report["length_m"], 6.28);  // the straight line
  EXPECT_LT(report["length_m"], 6.6);
  EXPECT_GT(report["least_clearance_m"], 0.3);
  EXPECT_LT(report["least_clearance_m"], 0.46) << "half of the windows";
  // The camera looks where it goes.
  for (std::size_t i = 1; i < flight.poses.size(); ++i) {
    const Pose &a = flight.poses[i - 1].world_from_camera, &b = flight.poses[i].world_from_camera;
    if (distance(a.translation, b.translation) < 1e-6) continue;
    EXPECT_GT(dot(normalized(b.translation - a.translation), b.rotation.rotate({1, 0, 0})), 0.8);
  }
}

// Half a circle around a block, which a column stands in, and then through a place that the block hides.
TEST(Avoid, AnOrbitGoesAroundWhatStandsInItAndOnToWaypoints) {
  const SettledMission m = settle_text(
      "local orbit = rubble.trajectory.orbit { centre = { 0, 0, 0.5 }, radius_m = 3, height = 1, turns = 0.5, speed = 1 }\n"
      "return rubble.mission { pile = { layers = 0, placed = { { box = { 1, 1, 2 }, position = { 0, 0, 1 } }, "
      "{ box = { 0.3, 0.3, 3 }, position = { 0, -3, 1.5 } } } }, trajectory = rubble.trajectory.join({ orbit, "
      "{ { position = { -2, 2, 1 } } } }, { plan = 'avoid', radius = 0.2, speed = 0.5, rate_hz = 10 }) }");
  const FlightPlan flight = plan(m);
  const PileQueries queries = m.queries();
  double nearest_to_column = 1e9;
  for (const CameraPose& pose : flight.poses) {
    const Vec3 p = pose.world_from_camera.translation;
    EXPECT_GE(queries.clearance(p), 0.199);
    nearest_to_column = std::min(nearest_to_column, std::hypot(p.x, p.y + 3));
  }
  EXPECT_LT(nearest_to_column, 0.7) << "it goes around it closely";
  EXPECT_NEAR(distance(flight.poses.front().world_from_camera.translation, {-3, 0, 1.5}), 0, 1e-6);
  EXPECT_NEAR(distance(flight.poses.back().world_from_camera.translation, {-2, 2, 1}), 0, 0.06);
  // On the circle, and around the column, the view stays on its centre, but for the roundings of the path.
  for (const CameraPose& pose : flight.poses) {
    const Vec3 p = pose.world_from_camera.translation;
    if (p.x > 2) break;
    EXPECT_GT(dot(pose.world_from_camera.rotation.rotate({1, 0, 0}), normalized(Vec3{0, 0, 0.5} - p)), 0.99);
  }
}

TEST(Avoid, ReportsTheWidestGapWhereThereIsNoWay) {
  const SettledMission m = scene(tunnel(0.9, 0.5),
                                 "plan = 'avoid', radius = 0.35, waypoints = { "
                                 "{ position = { -3, 0, 1.2 } }, { position = { 3.2, 1, 1.2 } } }");
  const std::string error = plan_error(m);
  EXPECT_NE(error.find("trajectory.waypoints[2].position: no path from"), std::string::npos) << error;
  EXPECT_NE(error.find("a path for a radius of 0.350 m"), std::string::npos) << error;
  const std::string found = "found a path for ";
  const std::size_t at = error.find(found);
  ASSERT_NE(at, std::string::npos) << error;
  EXPECT_NEAR(std::stod(error.substr(at + found.size())), 0.25, 0.05) << error;
  EXPECT_NE(error.find("narrowest at {2."), std::string::npos) << error;
}

TEST(Avoid, AStraightWayIsLeftStraight) {
  const SettledMission m = scene("{ box = { 1, 1, 1 }, position = { 0, 0, 0.5 } }",
                                 "plan = 'avoid', radius = 0.2, speed = 2, waypoints = { "
                                 "{ position = { -8, 0, 2 } }, { position = { 8, 0, 2 } } }");
  const FlightPlan flight = plan(m);
  EXPECT_EQ(flight.trajectory.waypoints.size(), 2u);
  EXPECT_NEAR(nlohmann::json::parse(flight.json)["length_m"], 16, 1e-9);
}

TEST(Avoid, AWaypointInsideAPieceHasNoRoom) {
  const SettledMission m = scene("{ box = { 3, 3, 3 }, position = { 0, 0, 1.5 } }",
                                 "plan = 'avoid', radius = 0.2, waypoints = { "
                                 "{ position = { -8, 0, 2 } }, { position = { 0, 0, 1.5 } } }");
  EXPECT_NE(plan_error(m).find("waypoints[2].position: the camera's body does not fit there"), std::string::npos)
      << plan_error(m);
}

// With an inertial unit the way that is found has no corners, and yet keeps clear.
TEST(SmoothFlight, TheUnitFeelsTheWayAroundEverything) {
  for (const char* how : {"", "interpolation = 'spline', ", "max_acceleration = 2, max_jerk = 20, rest_at_ends = true, "}) {
    SettledMission m = scene(tunnel(0.9, 0.9) + ", rubble.wall { x0 = -1, x1 = -0.8, width = 1.6, y = 0.5, height = 3 }",
                             std::string(how) + "plan = 'avoid', radius = 0.3, speed = 1, waypoints = { "
                             "{ position = { -3, 0, 1.2 } }, { position = { 3.2, 1, 1.2 } } }");
    m.mission.scenario.imus = {ImuScenario{}};
    const FlightPlan flight = plan(m);
    const PileQueries queries = m.queries();
    const CameraPath path(flight.trajectory);
    for (double t = 0; t < path.duration(); t += 0.01)
      ASSERT_GE(queries.clearance(path.at(t).translation), 0.3 - 1e-5) << how << " at " << t;
    const DeadReckoning found = reckon(path);
    EXPECT_LT(found.worst, 0.01) << how << " at " << found.at;
    EXPECT_GT(found.seconds, 6) << how;
    const auto report = nlohmann::json::parse(flight.json);
    EXPECT_GT(report["smoothing_s"], 0.01);
    EXPECT_GT(report["least_clearance_m"], 0.3 - 1e-5);
    EXPECT_LE(report["waypoints"].back()["t"], double(report["duration_s"]) + 1e-9);
    EXPECT_GT(report["waypoints"].back()["t"], double(report["duration_s"]) * 0.9);
    // Where it is said to be when it is said to be there.
    for (const auto& w : report["waypoints"]) {
      const Vec3 p{w["position"][0], w["position"][1], w["position"][2]};
      EXPECT_LT(distance(path.at(w["t"]).translation, p), 0.1) << how;
    }
  }
}

TEST(SmoothFlight, ASplineAroundEverythingIsNotItsLegs) {
  const auto roughest = [](const char* how) {
    const SettledMission m = scene(tunnel(0.9, 0.9), std::string(how) + "plan = 'avoid', radius = 0.3, speed = 1, "
                                   "waypoints = { { position = { -3, 0, 1.2 } }, { position = { 3.2, 1, 1.2 } } }");
    const CameraPath path(plan(m).trajectory);
    double largest = 0;
    for (double t = 0.002; t < path.duration(); t += 0.001)
      largest = std::max(largest, norm(path.motion_at(t).velocity - path.motion_at(t - 0.001).velocity));
    return largest;
  };
  EXPECT_GT(roughest(""), 0.1);
  EXPECT_GT(roughest("interpolation = 'linear', "), 0.1);
  EXPECT_LT(roughest("interpolation = 'spline', "), 0.02);
}

// Straight to a corner and round it, with a pillar just inside of it: only a hair of room is left.
TEST(SmoothFlight, IsRefusedWhereThereIsNoRoomToRoundACorner) {
  const auto error = [](double pillar, bool imu) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "plan = 'refuse', radius = 0.3, interpolation = 'linear', waypoints = { { position = { -5, 0, 1 } }, "
                  "{ t = 0.125, position = { 0, 0, 1 } }, { t = 0.25, position = { 0, 5, 1 } } }");
    SettledMission m = scene("{ box = { 1, 1, 2 }, position = { " + std::to_string(-0.5 - pillar) + ", " +
                             std::to_string(0.5 + pillar) + ", 1 } }", text);
    m.mission.scenario.imus.resize(imu ? 1 : 0);
    return plan_error(m);
  };
  EXPECT_EQ(error(0.5, true), "");  // smoothed less, as times are the user's
  EXPECT_EQ(error(0.302, false), "");
  EXPECT_NE(error(0.302, true).find("imu.on: the path cannot be smoothed within the available clearance"),
            std::string::npos) << error(0.302, true);
}

// The bundled missions whose paths follow from the pile. The heap of the published demonstration is
// lowered: its height is not what matters here.
TEST(SmoothFlight, EveryBundledPlanLeadsToItsPoses) {
  for (const char* name : {"refuse", "deepest_void", "push", "paper/void_dark", "paper/void_lit"}) {
    MissionOptions options;
    options.overrides = {"imu.on=true"};
    if (std::string(name).rfind("paper", 0) == 0) options.overrides.push_back("pile.layers=3");
    const SettledMission m = settle(load_mission(RUBBLE_SOURCE_DIR "/scripts/" + std::string(name) + ".lua", options));
    const DeadReckoning found = reckon(CameraPath(plan(m).trajectory));
    EXPECT_LT(found.worst, 0.01) << name << " at " << found.at << " s of " << found.seconds;
  }
}

// Measures and a flight that ask the same of the pile share one map of its free space; another voxel is
// another question, and who asked before changes no answer.
TEST(PileSurvey, MakesAFreeSpaceOnceForTheSameQuestion) {
  const SettledMission m = scene(tunnel(0.9, 0.9), "waypoints = { { position = { 0, -9, 1 } } }");
  VoidSpaceOptions options;
  options.voxel = 0.1;
  PileSurvey shared(m.assets, m.state, 1), alone(m.assets, m.state, 1);
  const double large = shared.find_voids(options, {0.3}).robots.front().volume;
  const VoidMap& both = shared.find_voids(options, {0.2});
  EXPECT_EQ(shared.spaces_made(), 1);
  ASSERT_EQ(both.robots.size(), 2u);
  EXPECT_EQ(both.robots.front().volume, large);
  EXPECT_EQ(both.robots.back().volume, alone.find_voids(options, {0.2}).robots.front().volume);
  EXPECT_GT(both.robots.back().volume, large);
  options.voxel = 0.08;
  shared.find_voids(options, {});
  EXPECT_EQ(shared.spaces_made(), 2);
  shared.find_voids(options, {0.2});
  EXPECT_EQ(shared.spaces_made(), 2) << "a space that was made without robots serves them later";
}

// Two dead-end tunnels: a wide short one (larger) and a narrow long one (deeper).
std::string two_tunnels() {
  const auto tunnel = [](double y, double inner, double length) {
    char text[700];
    const double out = inner / 2 + 0.1;
    std::snprintf(text, sizeof text,
                  "rubble.wall { x0 = 0, x1 = %g, width = 0.2, y = %g, height = %g }, "
                  "rubble.wall { x0 = 0, x1 = %g, width = 0.2, y = %g, height = %g }, "
                  "rubble.wall { x0 = 0, x1 = %g, width = %g, y = %g, bottom = %g, height = %g }, "
                  "rubble.wall { x0 = %g, x1 = %g, width = %g, y = %g, height = %g }, ",
                  length, y - out, inner, length, y + out, inner, length, inner + 0.4, y, inner, inner + 0.2,
                  length, length + 0.2, inner + 0.4, y, inner + 0.2);
    return std::string(text);
  };
  return tunnel(-3, 1.6, 3) + tunnel(3, 0.8, 5);
}

TEST(FindVoid, OrdersByVolumeAndByDepth) {
  const auto fly_to = [](const std::string& options, const std::string& place) {
    const SettledMission m =
        scene(two_tunnels(), "waypoints = { { position = rubble.find_void { " + options + " }." + place +
                                 ", look_at = { 1, 0, 1 } } }");
    return plan(m).poses.front().world_from_camera.translation;
  };
  EXPECT_NEAR(fly_to("radius = 0.25", "deepest").y, -3, 1);
  EXPECT_NEAR(fly_to("radius = 0.25, rank = 2", "deepest").y, 3, 0.3);
  const Vec3 deep = fly_to("radius = 0.25, by = 'depth'", "deepest");
  EXPECT_NEAR(deep.y, 3, 0.3);
  EXPECT_NEAR(deep.x, 5 - 0.25, 0.2);
  const Vec3 entrance = fly_to("radius = 0.25, by = 'depth'", "entrance");
  EXPECT_NEAR(entrance.x, 0, 0.5);
  const Vec3 approach = fly_to("radius = 0.25, by = 'depth', approach = 2", "approach");
  EXPECT_LT(approach.x, entrance.x - 1.5);
}

TEST(FindVoid, SaysHowManyThereAre) {
  const SettledMission m = scene(
      two_tunnels(), "waypoints = { { position = rubble.find_void { radius = 0.25, rank = 3 }.widest } }");
  EXPECT_NE(plan_error(m).find("trajectory.waypoints[1].position: no such void in this pile: expected a rank from 1 "
                               "to 2, found rank 3"),
            std::string::npos)
      << plan_error(m);
  const SettledMission none = scene(
      two_tunnels(), "waypoints = { { position = rubble.find_void { radius = 0.95 }.widest } }");
  EXPECT_NE(plan_error(none).find("a void that a sphere of radius 0.95 m can enter, found none"), std::string::npos)
      << plan_error(none);
}

// The promise of the two together: into the deepest void of a lean-to, whatever the seed.
TEST(FindVoid, IntoTheDeepestVoidForAnySeed) {
  for (const int seed : {1, 2}) {
    const SettledMission m = settle_text(
        "local void = rubble.find_void { radius = 0.25, by = 'depth' }\n"
        "return rubble.mission { seed = " + std::to_string(seed) +
        ", pile = rubble.collapse.lean_to { debris = { layers = 1, pieces_per_layer = 40 } }, "
        "trajectory = { plan = 'avoid', radius = 0.2, speed = 1, rate_hz = 10, waypoints = { "
        "{ position = { 2, -9, 2 } }, { position = void.deepest } } } }");
    const FlightPlan flight = plan(m);
    const PileQueries queries = m.queries();
    for (const CameraPose& pose : flight.poses)
      EXPECT_GE(queries.clearance(pose.world_from_camera.translation), 0.199) << seed;
    const Vec3 end = flight.poses.back().world_from_camera.translation;
    EXPECT_TRUE(queries.cast_ray(end, {0, 0, 1}, 3)) << "under the slab";
    EXPECT_EQ(flight.json, plan(m).json) << "the same again";
  }
}

}  // namespace flight_test
}  // namespace rubble::testing
