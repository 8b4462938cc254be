// The paths and densities of the library: what they sample to, and how they say what is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/scripting/script_files.h"

namespace rubble {
namespace path_library_test {

constexpr double kDegree = 3.14159265358979323846 / 180;

std::vector<CameraPose> fly(const std::string& trajectory) {
  const Scenario s = load_text("return rubble.mission { trajectory = " + trajectory + " }").scenario;
  return sample_trajectory(s.trajectory, s.start_ns);
}

Vec3 forward(const CameraPose& pose) { return pose.world_from_camera.rotation.rotate({1, 0, 0}); }

TEST(Paths, AnOrbitIsACircleThatLooksAtItsCentre) {
  const auto poses = fly("rubble.trajectory.orbit { centre = {1, 2, 0.5}, radius_m = 5, height = 3, speed = 2 }");
  EXPECT_NEAR(double(poses.size()), 30 * 2 * 3.14159265 * 5 / 2, 2);
  for (const CameraPose& pose : poses) {
    const Vec3 p = pose.world_from_camera.translation - Vec3{1, 2, 0.5};
    EXPECT_NEAR(std::hypot(p.x, p.y), 5, 1e-3);
    EXPECT_NEAR(p.z, 3, 1e-9);
    EXPECT_NEAR(distance(forward(pose), normalized(-p)), 0, 1e-9);
  }
  EXPECT_NEAR(distance(poses.front().world_from_camera.translation, {-4, 2, 3.5}), 0, 1e-9);
}

TEST(Paths, ASpiralNarrowsAndSinks) {
  const auto poses = fly("rubble.trajectory.spiral { radii = {8, 3}, heights = {4, 1}, turns = 1.5, speed = 3 }");
  const auto radius = [](const CameraPose& pose) {
    return std::hypot(pose.world_from_camera.translation.x, pose.world_from_camera.translation.y);
  };
  EXPECT_NEAR(radius(poses.front()), 8, 1e-9);
  EXPECT_NEAR(radius(poses.back()), 3, 0.1);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_LT(radius(poses[i]), radius(poses[i - 1]));
    EXPECT_NEAR(distance(poses[i].world_from_camera.translation,
                         poses[i - 1].world_from_camera.translation) * 30, 3, 0.05);
  }
}

TEST(Paths, APushGoesStraightAlongItsAxis) {
  const auto poses = fly("rubble.trajectory.push { from = {-3, 1, 0.5}, to = {1, -2, 0.7}, speed = 1, roll_deg = 90 }");
  const Vec3 way = normalized(Vec3{4, -3, 0.2});
  for (const CameraPose& pose : poses) {
    EXPECT_NEAR(distance(forward(pose), way), 0, 1e-9);
    EXPECT_NEAR(norm(cross(pose.world_from_camera.translation - Vec3{-3, 1, 0.5}, way)), 0, 1e-9);
  }
  const Vec3 left = poses.back().world_from_camera.rotation.rotate({0, 1, 0});
  EXPECT_GT(std::abs(left.z), 0.99) << "rolled by 90 degrees at the end";
}

TEST(Paths, AGrowingRobotGoesForwardAndBendsNoMoreThanItMay) {
  const auto poses = fly(
      "rubble.trajectory.grow { from = {0, 0, 1}, yaw_deg = 0, towards = { {3, 2, 1}, {3, 5, 0.6} }, "
      "turn_deg_per_m = 50, speed = 0.5, rate_hz = 20 }");
  double nearest = 1e9;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Vec3 step = poses[i].world_from_camera.translation - poses[i - 1].world_from_camera.translation;
    EXPECT_GT(dot(normalized(step), forward(poses[i])), std::cos(3 * kDegree)) << i;
    const double turn = std::acos(std::min(1.0, dot(forward(poses[i]), forward(poses[i - 1]))));
    EXPECT_LT(turn / kDegree / norm(step), 50 * 1.1) << i;
    nearest = std::min(nearest, distance(poses[i].world_from_camera.translation, {3, 2, 1}));
  }
  EXPECT_LT(nearest, 0.2);
  EXPECT_LT(distance(poses.back().world_from_camera.translation, {3, 5, 0.6}), 0.3);
}

TEST(Paths, AGrowingRobotSaysWhatItCannotReach) {
  EXPECT_EQ(mission_error("return { trajectory = rubble.trajectory.grow {\n from = {0, 0, 1}, yaw_deg = 0,\n"
                          " towards = { {0, 0.5, 1} }, turn_deg_per_m = 10, length = 30 } }")
                .find("m.lua:3: rubble.trajectory.grow.towards: out of range: expected points that it can reach"),
            0u);
}

TEST(Paths, AFunctionIsAskedOnceAFrame) {
  const auto poses = fly(
      "rubble.trajectory.along(function(t) return { t, t * t, 1 }, { 10, 0, 1 } end, { duration = 2, rate_hz = 10 })");
  ASSERT_EQ(poses.size(), 21u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t = double(i) / 10;
    EXPECT_NEAR(distance(poses[i].world_from_camera.translation, {t, t * t, 1}), 0, 1e-12);
    EXPECT_NEAR(distance(forward(poses[i]), normalized(Vec3{10 - t, -t * t, 0})), 0, 1e-12);
  }
  EXPECT_EQ(mission_error("return { trajectory = rubble.trajectory.along(5) }"),
            "m.lua:1: rubble.trajectory.along takes a function of time first, not a number");
  EXPECT_EQ(mission_error("return { trajectory = rubble.trajectory.along(function() end) }"),
            "m.lua:1: rubble.trajectory.along: f(0.0) gives no position {x, y, z}");
  EXPECT_NE(mission_error("return { trajectory = rubble.trajectory.along(function(t) while true do end end) }"), "");
}

class PathFiles : public ScriptFiles {
 protected:
  std::vector<CameraPose> poses(const std::string& trajectory) {
    const Scenario s = load("trajectory = " + trajectory).scenario;
    return sample_trajectory(s.trajectory, s.start_ns);
  }
};

// What we wrote ourselves, read back: groundtruth.txt holds optical frames.
TEST_F(PathFiles, ATumFileIsFlownAgain) {
  const Scenario s = load_text("return { trajectory = { rate_hz = 10, waypoints = { { position = {0, 0, 1}, rpy_deg = {5, 10, 30} }, "
                               "{ t = 1, position = {2, 1, 1.5}, rpy_deg = {-20, 40, 170} } } } }").scenario;
  const auto original = sample_trajectory(s.trajectory, s.start_ns);
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const CameraPose& pose : original) {
    const Pose optical = pose.world_from_camera * camera_from_optical;
    char line[256];
    std::snprintf(line, sizeof line, "%.9f %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", double(pose.stamp_ns) * 1e-9,
                  optical.translation.x, optical.translation.y, optical.translation.z, optical.rotation.x,
                  optical.rotation.y, optical.rotation.z, optical.rotation.w);
    text += line;
  }
  write("path.txt", text);
  const auto again = poses("rubble.trajectory.file { path = 'path.txt', rate_hz = 10 }");
  ASSERT_EQ(again.size(), original.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    const Pose a = original[i].world_from_camera, b = again[i].world_from_camera;
    EXPECT_NEAR(distance(a.translation, b.translation), 0, 1e-8);
    const Quat d = a.rotation.conjugate() * b.rotation;
    EXPECT_NEAR(norm(Vec3{d.x, d.y, d.z}), 0, 1e-7);
  }
}

TEST_F(PathFiles, ACsvFileNamesItsColumns) {
  write("path.csv", "x, y, z, yaw_deg, t\n0, 0, 1, 0, 5\n1, 0, 1, 90, 6\n2, 0, 1, 90, 8\n");
  const Mission mission = load("trajectory = rubble.trajectory.file { path = 'path.csv', slower = 2 }");
  const auto& w = mission.scenario.trajectory.waypoints;
  ASSERT_EQ(w.size(), 3u);
  EXPECT_EQ(w[2].t, 6);
  EXPECT_EQ(w[1].rpy_deg, Vec3(0, 0, 90));
  ASSERT_EQ(mission.included.size(), 1u) << "what it was made from belongs to the recipe";
}

// A camera that looks straight down and turns: pitch is 90 degrees all along.
TEST_F(PathFiles, ANadirPathKeepsItsTurn) {
  std::string text;
  std::vector<Quat> optical;
  for (int i = 0; i < 12; ++i) {
    const double half = 0.3 * i;
    optical.push_back({0, std::cos(half), std::sin(half), 0});
    char line[128];
    std::snprintf(line, sizeof line, "%.1f %.1f 0 3 %.12f %.12f 0 0\n", 0.1 * i, 0.1 * i, optical.back().x, optical.back().y);
    text += line;
  }
  write("down.txt", text);
  const auto flown = poses("rubble.trajectory.file { path = 'down.txt', rate_hz = 10 }");
  ASSERT_EQ(flown.size(), optical.size());
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const Quat d = (flown[i].world_from_camera.rotation * camera_from_optical.rotation).conjugate() * optical[i];
    EXPECT_NEAR(norm(Vec3{d.x, d.y, d.z}), 0, 1e-8) << i;
  }
}

TEST_F(PathFiles, EveryFormatFliesTheSamePath) {
  write("tum.txt", "1.7e9 0 -4 2 -0.5 0.5 -0.5 0.5\n1700000000.005 1 -4 2 -0.5 0.5 -0.5 0.5\n1700000000.005 9 9 9 0 0 0 1\n1700000000.01 2 -4 2 -0.5 0.5 -0.5 0.5\n");
  write("euroc.csv", "\xef\xbb\xbf#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\r\n"
                     "1700000000000000000,0,-4,2,1,0,0,0\r\n1700000000005000000,1,-4,2,1,0,0,0\r\n1700000000010000000,2,-4,2,1,0,0,0\r\n");
  write("named.csv", "#t,x,y,z,qx,qy,qz,qw\n0,+0,-4,2,0,0,0,1\n5e-3,1,-4,2,0,0,0,1\n0.01,2,-4,2,0,0,0,1\n");
  write("mm.csv", "yaw_rad;z_mm;y (mm);x (mm);t_ms\n0;2000;-4000;0;0\n0;2000;-4000;1000;5\n0;2000;-4000;2000;10\n");
  // In KITTI's world Z is forward and Y is down.
  write("kitti.txt", "1 0 0 4 0 1 0 -2 0 0 1 0\n1 0 0 4 0 1 0 -2 0 0 1 1\n1 0 0 4 0 1 0 -2 0 0 1 2\n");
  const std::pair<const char*, const char*> files[] = {{"tum.txt", "TUM"}, {"euroc.csv", "stamps in ns"}, {"named.csv", "line 1 names"},
                                                       {"mm.csv", "stamps in ms"}, {"kitti.txt", "KITTI"}};
  for (const auto& [file, format] : files) {
    const std::string more = std::string(format) == "KITTI" ? ", interval = 0.005" : "";
    const Mission mission = load("trajectory = rubble.trajectory.file { path = '" + std::string(file) + "'" + more + " }");
    const auto& w = mission.scenario.trajectory.waypoints;
    ASSERT_EQ(w.size(), 3u) << file;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(*w[i].t, 0.005 * double(i), 1e-12) << file;
      EXPECT_NEAR(distance(w[i].position, {double(i), -4, 2}), 0, 1e-12) << file;
      EXPECT_NEAR(norm(w[i].rpy_deg), 0, 1e-9) << file;
    }
    ASSERT_FALSE(mission.printed.empty());
    EXPECT_NE(mission.printed[0].find(format), std::string::npos) << mission.printed[0];
  }
}

TEST_F(PathFiles, MistakesInFilesNameTheirLine) {
  const auto error = [&](const std::string& text) { return error_of([&] { load(text); }); };
  write("a.csv", "t,x,y,z\n0,1,2,3\n1,1,two,3\n");
  EXPECT_NE(error("trajectory = rubble.trajectory.file { path = 'a.csv' }").find("a.csv:3: no number in the column y"),
            std::string::npos);
  write("b.csv", "t,x,y\n0,1,2\n");
  EXPECT_NE(error("trajectory = rubble.trajectory.file { path = 'b.csv' }").find("b.csv has no column z"), std::string::npos);
  write("c.txt", "# nothing\n");
  EXPECT_NE(error("trajectory = rubble.trajectory.file { path = 'c.txt' }").find("c.txt has no pose"), std::string::npos);
  EXPECT_NE(error("trajectory = rubble.trajectory.file { path = '../c.txt' }").find("is not a path inside"), std::string::npos);
  write("d.csv", "0,1,2,3,0,0,0,1\n0.1,1,2,3,0,0,0,1\n");
  EXPECT_NE(error("trajectory = rubble.trajectory.file { path = 'd.csv' }").find("d.csv:1: the order of the columns is not known"), std::string::npos);
  EXPECT_EQ(load("trajectory = rubble.trajectory.file { path = 'd.csv', columns = 't,x,y,z,qx,qy,qz,qw' }").scenario.trajectory.waypoints.size(), 2u);
  write("e.txt", "1 0 0 4 0 1 0 -2 0 0 1 0\n");
  EXPECT_NE(error("trajectory = rubble.trajectory.file { path = 'e.txt' }").find("e.txt has no stamps: give `interval`"), std::string::npos);
  EXPECT_NE(error("trajectory = rubble.trajectory.file {}").find("rubble.trajectory.file.path: out of range"), std::string::npos);
}

TEST_F(PathFiles, ATrajectoryIsReadWithAndWithoutOptions) {
  write("a.csv", "t,x,y,z\n0,1,2,3\n1,1,2,3\n");
  const auto read = [&](const std::string& options) {
    return "trajectory = { waypoints = rubble.read_trajectory('a.csv'" + options + ").poses }";
  };
  const auto error = [&](const std::string& options) { return error_of([&] { load(read(options)); }); };
  EXPECT_EQ(load(read("")).scenario.trajectory.waypoints.size(), 2u);
  EXPECT_EQ(load(read(", { frame = 'body' }")).scenario.trajectory.waypoints.size(), 2u);
  EXPECT_NE(error(", { fram = 'body' }").find("rubble.read_trajectory: unknown key `fram`: expected frame, columns"), std::string::npos);
  EXPECT_NE(error(", { frame = 'boby' }").find("expected \"optical\", \"body\" or \"as the format says\", found \"boby\""), std::string::npos);
  EXPECT_NE(error(", { columns = {} }").find("rubble.read_trajectory: columns: expected a string, found a table"), std::string::npos);
}

// 2 x 2 pixels, grey: 255 0 / 64 128. Written by another program.
const unsigned char kPng[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x00, 0x00, 0x00, 0x00, 0x57, 0xdd, 0x52,
    0xf8, 0x00, 0x00, 0x00, 0x0e, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xcf, 0xc0, 0xe0,
    0xd0, 0x00, 0x00, 0x06, 0x01, 0x01, 0xc0, 0x0b, 0xb3, 0x1a, 0x0f, 0x00, 0x00, 0x00, 0x00, 0x49,
    0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST_F(PathFiles, ADensityImageIsReadTopDown) {
  write("map.png", std::string(reinterpret_cast<const char*>(kPng), sizeof kPng));
  const Mission mission = load("pile = { spawn_density = rubble.density.image('map.png') }");
  const SpawnDensity& d = mission.scenario.pile.spawn_density;
  EXPECT_EQ(d.columns, 2);
  EXPECT_EQ(d.rows, 2);
  ASSERT_EQ(d.weights.size(), 4u);
  const double expected[] = {64.0 / 255, 128.0 / 255, 1, 0};  // the lowest y first
  for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(d.weights[i], expected[i]) << i;
  // The manifest keeps it as text, from which the script can be run again.
  ASSERT_EQ(mission.included.size(), 1u);
  EXPECT_EQ(mission.included[0].text, "P2\n2 2\n255\n255 0\n64 128\n");
  MissionOptions options;
  options.included.emplace();
  (*options.included)["map.png"] = mission.included[0].text;
  const Mission again = load_mission_text(mission.script.text, mission.script.path, options);
  EXPECT_EQ(again.scenario.pile.spawn_density.weights, d.weights);
  write("bad.png", std::string(reinterpret_cast<const char*>(kPng), 40));
  EXPECT_NE(error_of([&] { load("pile = { spawn_density = rubble.density.image('bad.png') }"); }).find("\"bad.png\" is a damaged PNG"),
            std::string::npos);
  write("no.png", "P7");
  EXPECT_NE(error_of([&] { load("pile = { spawn_density = rubble.density.image('no.png') }"); }).find("\"no.png\" is no picture; PNG, JPEG, TIFF, OpenEXR, WebP, BMP, PGM, PPM, PBM and PFM are read"),
            std::string::npos);
}

SpawnDensity density(const std::string& text) {
  return load_text("return { pile = { spawn_density = " + text + " } }").scenario.pile.spawn_density;
}

TEST(Densities, AreGrids) {
  const SpawnDensity g = density("rubble.density.gaussian { deviation = 0.5 }");
  ASSERT_EQ(g.weights.size(), std::size_t(g.columns * g.rows));
  const auto at = [&g](double x, double y) {
    return g.weights[std::size_t(int((y + 1) / 2 * g.rows) * g.columns + int((x + 1) / 2 * g.columns))];
  };
  EXPECT_NEAR(at(0.5, 0) / at(0, 0), std::exp(-0.5), 0.05);
  EXPECT_NEAR(at(0, -0.5) / at(0, 0), std::exp(-0.5), 0.05);
  const SpawnDensity ring = density("rubble.density.ring { inner = 0.5, outer = 0.9 }");
  const double share = double(std::count(ring.weights.begin(), ring.weights.end(), 1)) / double(ring.weights.size());
  EXPECT_NEAR(share, 3.14159265 / 4 * (0.81 - 0.25), 0.01);
  const SpawnDensity f = density("rubble.density.from(function(x, y) return x > 0 and y < 0 and 2 or 0 end, { columns = 4, rows = 2 })");
  EXPECT_EQ(f.weights, (std::vector<double>{0, 0, 2, 2, 0, 0, 0, 0}));
}

TEST(Densities, Mistakes) {
  EXPECT_EQ(mission_error("return { pile = { spawn_density = rubble.density.gaussian { deviaton = 1 } } }"),
            "m.lua:1: rubble.density.gaussian.deviaton: unknown key `deviaton` (did you mean `deviation`?)");
  EXPECT_NE(mission_error("return { pile = { spawn_density = rubble.density.from(function() return -1 end) } }"), "");
  EXPECT_EQ(mission_error("return { pile = { spawn_density = { columns = 2, rows = 2, weights = {1, 2, 3} } } }"),
            "m.lua:1: pile.spawn_density.weights: not a whole grid: expected columns * rows = 4 numbers, found 3 "
            "(rubble.density makes such grids)");
  EXPECT_EQ(mission_error("return { pile = { spawn_density = { columns = 1, rows = 2, weights = {0, 0} } } }"),
            "m.lua:1: pile.spawn_density.weights: all weights are 0: expected a weight above 0, found only weights of 0 "
            "(rubble.density makes such grids)");
}

TEST(FindVoid, StandsForPlacesUntilThePileHasSettled) {
  const Scenario s = load_text(R"(local void = rubble.find_void { radius = 0.3, rank = 2, by = "depth" }
    return rubble.mission { trajectory = { plan = "avoid", waypoints = {
      { position = void.approach, look_at = void.entrance }, { position = void.deepest } } } })").scenario;
  const auto& w = s.trajectory.waypoints;
  ASSERT_TRUE(w[0].position_in_void && w[0].look_at_in_void && w[1].position_in_void);
  EXPECT_EQ(w[0].position_in_void->radius, 0.3);
  EXPECT_EQ(w[0].position_in_void->rank, 2);
  EXPECT_EQ(w[0].position_in_void->order, VoidPlace::Order::depth);
  EXPECT_EQ(w[0].position_in_void->point, VoidPlace::Point::approach);
  EXPECT_EQ(w[1].position_in_void->point, VoidPlace::Point::deepest);
  EXPECT_TRUE(s.trajectory.needs_pile());
  EXPECT_EQ(scenario_to_json(scenario_from_json(scenario_to_json(s), "s")), scenario_to_json(s));
  EXPECT_THROW(sample_trajectory(s.trajectory, 0), InputError);
}

// A quarter of a circle at 2 m/s, on to its centre's height at 0.5 m/s, into a void, and straight ahead at 1 m/s.
TEST(Paths, JoinedPathsGoOnFromEachOther) {
  const char* const kParts =
      "local void = rubble.find_void {}\nlocal orbit = rubble.trajectory.orbit { centre = {0, 0, 1}, radius_m = 4, "
      "height = 0, turns = 0.25, speed = 2, start_deg = 0 }\n";
  const auto load_path = [&](const std::string& path) {
    return load_text(kParts + ("return rubble.mission { trajectory = " + path + " }")).scenario;
  };
  const Scenario s = load_path("rubble.trajectory.join({ orbit, { { position = { 0, 4, 2 } }, { position = void.deepest } },"
                               " rubble.trajectory.push { from = {5, 0, 1}, to = {7, 0, 1}, speed = 1 } }, { plan = 'avoid' })");
  const std::vector<Waypoint>& w = s.trajectory.waypoints;
  ASSERT_EQ(w.size(), 31u + 2 + 2);
  EXPECT_EQ(s.trajectory.plan, Plan::avoid);
  EXPECT_EQ(w[0].speed, std::nullopt);
  for (std::size_t i = 1; i <= 30; ++i) EXPECT_NEAR(*w[i].speed, 2, 0.01);
  EXPECT_EQ(*w[31].speed, 0.5);
  EXPECT_TRUE(w[32].position_in_void);
  EXPECT_NEAR(*w[34].speed, 1, 1e-9);
  const auto poses = sample_trajectory(
      load_path("rubble.trajectory.join({ orbit, { position = {0, 4, 2}, look_at = {0, 0, 1} } })").trajectory, 0);
  EXPECT_NEAR(double(poses.size() - 1) / 30, 3.14159 + 2, 0.05);
  EXPECT_NEAR(distance(poses.back().world_from_camera.translation, {0, 4, 2}), 0, 0.02);
  // One path with a plan of its own: its times become speeds.
  const Scenario spiral = load_path("rubble.trajectory.spiral { speed = 3, plan = 'avoid' }");
  EXPECT_FALSE(spiral.trajectory.waypoints[5].t);
  EXPECT_NEAR(*spiral.trajectory.waypoints[5].speed, 3, 1e-9);
}

TEST(Paths, WhatCannotBeJoinedIsSaid) {
  const auto join_error = [](const std::string& parts, const std::string& options = "{}") {
    return mission_error("local orbit = rubble.trajectory.orbit { turns = 0.1, max_speed = 1 }\nlocal v = rubble.find_void {}\nreturn { "
                         "trajectory = rubble.trajectory.join(" + parts + ", " + options + ") }");
  };
  EXPECT_EQ(join_error("{ orbit }"), "m.lua:3: rubble.trajectory.join: part 1 has `max_speed`: give it in the options of rubble.trajectory.join");
  EXPECT_EQ(join_error("{ orbit }", "{ max_speed = 1 }"), "");
  EXPECT_EQ(join_error("{ 5 }"), "m.lua:3: rubble.trajectory.join: part 1 is no path but a number");
  EXPECT_EQ(join_error("{}"), "m.lua:3: rubble.trajectory.join has no waypoint");
  EXPECT_NE(join_error("{ { { position = {0, 0, 1} }, { t = 1, position = {0, 0, 1} } } }").find("stands still"), std::string::npos);
  EXPECT_NE(join_error("{ { { position = v.deepest }, { t = 1, position = {0, 0, 1} } } }").find("give a `speed`"), std::string::npos);
}

TEST(FindVoid, Mistakes) {
  EXPECT_EQ(mission_error("local v = rubble.find_void { radios = 1 }\nreturn {}"),
            "m.lua:1: rubble.find_void.radios: unknown key `radios` (did you mean `radius`?)");
  EXPECT_EQ(mission_error("return { trajectory = { plan = 'avoid', waypoints = { { position = {0, 0, 1} } } } }"),
            "m.lua:1: trajectory.waypoints: the plan needs a destination: expected at least two waypoints for the plan \"avoid\", found 1");
  EXPECT_EQ(mission_error("return { trajectory = { plan = 'avoid', waypoints = { { position = {0, 0, 1} },\n"
                          "{ position = {1, 0, 1}, t = 2 } } } }"),
            "m.lua:2: trajectory.waypoints[2].t: contradicts the plan \"avoid\": expected `speed`, because the length of the "
            "path is not known yet, found 2");
  EXPECT_NE(mission_error("return { trajectory = { waypoints = { { position = { find_void = { rank = 0 } } } } } }"), "");
}

TEST_F(PathFiles, PlansAreReadLineByLine) {
  write("house.txt",
        "# a house\nstorey 3\nstorey 2.5\nwall 0 0 6 0 0.3 block name=south\nstoreys 1 1\n"
        "column 3 2 0.4 0.3 bars=0.02\nbeam,0,2,6,2,0.3,0.45,concrete\ndoor 1 0 2 0 2.1\nwall 0 0 0 4 0.2\n");
  const Mission mission = load("pile = rubble.building { plan = rubble.read_plan('house.txt') }");
  const BuildingPlan& plan = mission.scenario.pile.building.plan;
  EXPECT_EQ(plan.heights, (std::vector<double>{3, 2.5}));
  ASSERT_EQ(plan.parts.size(), 5u);
  EXPECT_EQ(plan.parts[0].name, "south");
  EXPECT_EQ(plan.parts[0].material, PlanMaterial::block);
  EXPECT_EQ(plan.parts[0].highest, 11);
  EXPECT_EQ(plan.parts[1].lowest, 1);
  EXPECT_NEAR(plan.parts[1].x1, 2.8, 1e-12);
  EXPECT_NEAR(plan.parts[1].y2, 2.15, 1e-12);
  EXPECT_EQ(plan.parts[1].bars, 0.02);
  EXPECT_EQ(plan.parts[2].depth, 0.45);
  EXPECT_EQ(plan.parts[3].kind, PlanKind::window);
  EXPECT_EQ(plan.parts[3].bottom, 0);
  EXPECT_EQ(plan.parts[4].material, PlanMaterial::brick) << "what walls are usually made of";
  EXPECT_EQ(plan.parts[4].name, "house.txt:9");
}

TEST_F(PathFiles, MistakesInPlansHaveTheirLine) {
  const auto plan_error = [&](const std::string& text) {
    write("bad.txt", text);
    return error_of([&] { load("pile = rubble.building { plan = rubble.read_plan('bad.txt') }"); });
  };
  EXPECT_NE(plan_error("storey 3\nwal 0 0 1 0 0.3\n").find("bad.txt:2: unknown part `wal`"), std::string::npos);
  EXPECT_NE(plan_error("storey 3\nwall 0 0 1 0\n").find("bad.txt:2: wall: expected 5 numbers"), std::string::npos);
  EXPECT_NE(plan_error("storey 3\nwall 0 0 1 zero 1\n").find("`zero` as y2"), std::string::npos);
  EXPECT_NE(plan_error("storey 3\nwall 0 0 1 0 0.3 straw\n").find("unknown word `straw`"), std::string::npos);
  EXPECT_NE(plan_error("wall 0 0 1 0 0.3\n").find("has no storey"), std::string::npos);
  EXPECT_NE(plan_error("storey 3\n").find("draws nothing"), std::string::npos);
  EXPECT_NE(plan_error("storey 3\nstoreys 2 1\nwall 0 0 1 0 0.3\n").find("bad.txt:2: storeys"), std::string::npos);
}

}  // namespace path_library_test
}  // namespace rubble
