// LiDARs against closed forms: a room, the ground, a wall that comes nearer, fog, edges.
#include "render/lidar/lidar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "kernel/base/portable_math.h"
#include "render/materials/surface_appearance.h"
#include "scripting/mission.h"
#include "scripting/sensors/lidar.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace lidar_test {

constexpr double kPi = portable::kPi;

// Lines of light without noise, limits or rounding.
LidarSpec ideal(LidarModel model = LidarModel::vlp16) {
  LidarFigures lidar;
  lidar.model = model;
  lidar.range_step = 0, lidar.divergence_mrad = 0;
  lidar.min_range = 0.01, lidar.max_range = 100, lidar.range_at_10_percent = 1000;
  LidarSpec spec = lidar.spec();
  spec.noise = false;
  return spec;
}

Scene place_boxes(const std::vector<std::pair<Vec3, Pose>>& boxes) {
  Scene scene;
  scene.ground = false;
  for (const auto& [size, pose] : boxes) {
    SceneInstance instance;
    instance.mesh = std::uint32_t(scene.meshes.size());
    instance.world_from_body = pose;
    instance.id = instance.mesh;
    scene.meshes.push_back(share(make_box(size)));
    scene.instances.push_back(instance);
  }
  return scene;
}

LidarPlace standing(const Pose& pose = {}) {
  return {[pose](std::int64_t) { return pose; }, 1'000'000'000};
}

RangeScan scan_of(const LidarSpec& spec, const Scene& scene, const LidarPlace& place, int number = 0,
                  int threads = 1, std::uint64_t seed = 3) {
  Lidar lidar(spec, std::make_shared<RayWorld>(scene), place, Medium(scene.air, scene.seed), seed, threads);
  return lidar.take(number);
}

Vec3 place_of(const ScanPoint& p) { return {double(p.x), double(p.y), double(p.z)}; }

// From inside a box around the origin: how far its wall is.
double wall_distance(const Vec3& from, const Vec3& direction, const Vec3& size) {
  double nearest = 1e9;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) continue;
    nearest = std::min(nearest, ((direction[i] > 0 ? 0.5 : -0.5) * size[i] - from[i]) / direction[i]);
  }
  return nearest;
}

// How far from the nearest of its six faces.
double off_the_walls(const Vec3& p, const Vec3& size) {
  double least = 1e9;
  for (int i = 0; i < 3; ++i) least = std::min(least, std::fabs(std::fabs(p[i]) - 0.5 * size[i]));
  return least;
}

const Vec3 kRoom(9, 7, 5);

TEST(LidarRange, IsThatOfATurnedRoomToFloatPrecision) {
  const Pose world_from_room{portable::quat_from_rpy(0.2, -0.3, 0.7), {0.4, -0.2, 0.3}};
  const Pose world_from_sensor{portable::quat_from_rpy(-0.1, 0.15, 2), {1.1, 0.5, 0.2}};
  const Scene scene = place_boxes({{kRoom, world_from_room}});
  const RangeScan scan = scan_of(ideal(LidarModel::os1), scene, standing(world_from_sensor));
  ASSERT_EQ(scan.points.size(), 64u * 1024);
  const Pose room_from_lidar = world_from_room.inverse() * world_from_sensor;
  double worst = 0;
  for (const ScanPoint& p : scan.points) {
    const double range = norm(place_of(p));
    const Vec3 direction = room_from_lidar.rotation.rotate(place_of(p) * (1 / range));
    worst = std::max(worst, std::fabs(range - wall_distance(room_from_lidar.translation, direction, kRoom)));
  }
  EXPECT_LT(worst, 1e-5);  // single precision at 10 m, at grazing angles
}

TEST(LidarRange, OfTheGroundIsHeightOverSine) {
  Scene ground;
  const RangeScan scan = scan_of(ideal(), ground, standing({{}, {3, 4, 2}}));
  ASSERT_EQ(scan.points.size(), 7u * 1808);  // the lower half of the rings; the ground at -1 degree is 115 m away
  for (const ScanPoint& p : scan.points) {
    const double elevation = (-15 + 2 * p.ring) * kPi / 180;
    ASSERT_NEAR(norm(place_of(p)), 2 / std::sin(-elevation), 1e-5);
    ASSERT_NEAR(double(p.z), -2, 1e-6);
  }
}

TEST(LidarMotion, BendsAScanAndTheTruePosesStraightenIt) {
  const auto pose_at = [](std::int64_t stamp_ns) {
    const double t = double(stamp_ns - 1'000'000'000) * 1e-9;
    return Pose{portable::quat_from_rpy(0, 0.2 * t, 1.5 * t), Vec3(1.2, -0.5, 0.3) * t};
  };
  const Scene scene = place_boxes({{kRoom, {}}});
  const RangeScan scan = scan_of(ideal(), scene, {pose_at, 1'000'000'000}, 2);
  ASSERT_EQ(scan.stamp_ns, 1'200'000'000);
  double straight = 0, bent = 0, listed = 0;
  for (const ScanPoint& p : scan.points) {
    const std::int64_t offset = std::llround(double(p.time) * 1e9);
    straight = std::max(straight, off_the_walls(pose_at(scan.stamp_ns + offset) * place_of(p), kRoom));
    bent = std::max(bent, off_the_walls(pose_at(scan.stamp_ns) * place_of(p), kRoom));
    // By the list of poses alone, taken at the nearest millisecond before and moved on.
    const auto k = std::size_t(offset / RangeScan::kMotionStep);
    const double share = double(offset % RangeScan::kMotionStep) / double(RangeScan::kMotionStep);
    const Vec3 a = scan.world_from_sensor[k] * place_of(p), b = scan.world_from_sensor[k + 1] * place_of(p);
    listed = std::max(listed, off_the_walls(a * (1 - share) + b * share, kRoom));
  }
  EXPECT_LT(straight, 1e-5);
  EXPECT_LT(listed, 2e-5);
  EXPECT_GT(bent, 0.05);
}

// A wall that comes nearer at 2 m/s is met where it is at each ray's own time.
TEST(LidarMotion, OfWhatMovesIsThatOfEachRaysTime) {
  const auto wall = [](std::int64_t stamp_ns) {
    return Pose{{}, {6 - 2 * double(stamp_ns - 1'000'000'000) * 1e-9, 0, 0}};
  };
  Scene scene = place_boxes({{{0.2, 40, 40}, wall(1'000'000'000)}});
  scene.motion.moving = {0};
  scene.motion.poses_at = [wall](std::int64_t stamp_ns) { return std::vector<std::optional<Pose>>{wall(stamp_ns)}; };
  const RangeScan scan = scan_of(ideal(), scene, standing(), 1);
  ASSERT_GT(scan.points.size(), 5000u);
  double worst = 0, first = 1e9, last = 0;
  for (const ScanPoint& p : scan.points) {
    const std::int64_t offset = std::llround(double(p.time) * 1e9);
    const double x = wall(scan.stamp_ns + offset).translation.x - 0.1;
    worst = std::max(worst, std::fabs(double(p.x) - x));
    first = std::min(first, double(p.x)), last = std::max(last, double(p.x));
  }
  EXPECT_LT(worst, 1e-5);
  EXPECT_GT(last - first, 0.08);  // it moved while it was scanned
}

TEST(LidarSignal, IsThatOfLambertsLawAndReachesAsFarAsStated) {
  Scene ground;
  LidarSpec spec = ideal();
  spec.range_at_10_percent = 20;
  const double height = 2, albedo = double(mean_red_albedo(all_surface_appearances().back(), 1));
  const RangeScan scan = scan_of(spec, ground, standing({{}, {0, 0, height}}));
  std::set<int> seen;
  for (const ScanPoint& p : scan.points) {
    const double cosine = height / norm(place_of(p));
    ASSERT_NEAR(double(p.intensity), 100 * albedo * cosine, 1e-3);
    seen.insert(p.ring);
  }
  std::set<int> expected;
  for (int ring = 0; ring < 8; ++ring) {
    const double range = height / std::sin((15 - 2 * ring) * kPi / 180);
    if (albedo * (height / range) / (range * range) >= 0.1 / (20.0 * 20)) expected.insert(ring);
  }
  EXPECT_EQ(seen, expected);
  EXPECT_GT(expected.size(), 0u);
  EXPECT_LT(expected.size(), 8u);
}

// Through fog that throws nothing back, every echo is weaker by exp(-2 s r) (Beer, Lambert).
TEST(LidarFog, WeakensEchoesByBeersLaw) {
  Scene clear = place_boxes({{kRoom, {}}}), fog = clear;
  fog.air.fog_density = 0.3, fog.air.fog_intensity = 0;
  const RangeScan without = scan_of(ideal(), clear, standing()), with = scan_of(ideal(), fog, standing());
  ASSERT_EQ(with.points.size(), without.points.size());
  for (std::size_t i = 0; i < with.points.size(); ++i) {
    const double range = norm(place_of(with.points[i]));
    ASSERT_NEAR(double(with.points[i].intensity / without.points[i].intensity), std::exp(-0.6 * range), 1e-5);
  }
}

// Rain of 100 mm/h by the sum of the discs of its drops (Marshall and Palmer 1948).
TEST(LidarRain, WeakensEchoesByItsExtinction) {
  Scene clear = place_boxes({{kRoom, {}}}), rain = clear;
  rain.air.rain_mm_h = 100, rain.air.fog_intensity = 0;
  const double slope = 4.1 * std::pow(100, -0.21), extinction = kPi / 4 * 8000e-6 * 2 / (slope * slope * slope);
  const RangeScan without = scan_of(ideal(), clear, standing()), with = scan_of(ideal(), rain, standing());
  ASSERT_EQ(with.points.size(), without.points.size());
  for (std::size_t i = 0; i < with.points.size(); ++i) {
    const double range = norm(place_of(with.points[i]));
    ASSERT_NEAR(double(with.points[i].intensity / without.points[i].intensity), std::exp(-2 * extinction * range), 1e-5);
  }
}

// Without anything behind, ranges of fog have the density overlap(r) exp(-2 s r) / r^2.
TEST(LidarFog, EchoesWithTheDensityOfWhatItThrowsBack) {
  Scene fog;
  fog.ground = false;
  const double extinction = 0.2;
  fog.air.fog_density = extinction;
  LidarSpec spec = ideal();
  const RangeScan scan = scan_of(spec, fog, standing());
  ASSERT_GT(scan.points.size(), 16u * 1808 - 30);  // the farthest are too weak
  std::vector<double> ranges;
  for (const ScanPoint& p : scan.points) ranges.push_back(norm(place_of(p)));
  std::sort(ranges.begin(), ranges.end());
  const auto density = [&](double r) {
    return std::clamp((r - 0.9) / 0.1, 0.0, 1.0) * std::exp(-2 * extinction * r) / (r * r);
  };
  const double step = 1e-3;
  double whole = 0, sum = 0, worst = 0;
  for (double r = 0.9; r < 100; r += step) whole += density(r + step / 2) * step;
  std::size_t below = 0;
  for (double r = 0.9; r < 100; r += step) {
    sum += density(r + step / 2) * step / whole;
    while (below < ranges.size() && ranges[below] <= r + step) ++below;
    worst = std::max(worst, std::fabs(sum - double(below) / double(ranges.size())));
  }
  EXPECT_LT(worst, 0.02);  // Kolmogorov and Smirnov: 0.01 by chance in 1 of 200, and the steps of the sum
  // The smoke hides what is behind it once it is dense enough.
  Scene room = place_boxes({{kRoom, {}}});
  room.air.fog_density = 1.5;
  spec.range_at_10_percent = 35;
  std::size_t walls = 0;
  for (const ScanPoint& p : scan_of(spec, room, standing()).points) walls += off_the_walls(place_of(p), kRoom) < 0.02;
  EXPECT_EQ(walls, 0u);
}

// Half of the view is covered by a wall at 4 m before one at `far`.
Scene step_scene(double far) {
  return place_boxes({{{0.2, 20, 40}, {{}, {4.1, 10, 0}}}, {{0.2, 80, 80}, {{}, {far + 0.1, 0, 0}}}});
}

TEST(LidarDivergence, GivesPointsBetweenNearSurfacesAndTwoEchoesOfFarOnes) {
  LidarSpec spec = ideal(LidarModel::os1);
  spec.divergence_mrad = 5;
  const auto between = [](const RangeScan& scan, double far) {
    return std::count_if(scan.points.begin(), scan.points.end(), [far](const ScanPoint& p) {
      return std::fabs(p.y) < 1 && double(p.x) > 4.05 && double(p.x) < far - 0.05;
    });
  };
  EXPECT_GT(between(scan_of(spec, step_scene(4.5), standing()), 4.5), 30);
  spec.returns = LidarReturns::dual;
  const RangeScan apart = scan_of(spec, step_scene(7), standing());
  EXPECT_EQ(between(apart, 7), 0);
  int pairs = 0;
  for (std::size_t i = 1; i < apart.points.size(); ++i)
    pairs += apart.points[i].ring == apart.points[i - 1].ring && apart.points[i].column == apart.points[i - 1].column;
  EXPECT_GT(pairs, 30);
  spec.divergence_mrad = 0;
  EXPECT_EQ(between(scan_of(spec, step_scene(4.5), standing()), 4.5), 0);
}

TEST(LidarNoise, HasTheStatedDeviation) {
  LidarSpec spec = ideal();
  spec.noise = true, spec.range_noise = 0.02;
  const Scene scene = place_boxes({{kRoom, {}}});
  const RangeScan scan = scan_of(spec, scene, standing());
  double sum = 0, squares = 0;
  for (const ScanPoint& p : scan.points) {
    const double range = norm(place_of(p));
    const double error = range - wall_distance({}, place_of(p) * (1 / range), kRoom);
    sum += error, squares += error * error;
  }
  const double n = double(scan.points.size());
  EXPECT_NEAR(sum / n, 0, 4 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 4 * 0.02 / std::sqrt(2 * n));
}

std::string bytes_of(const RangeScan& scan) {
  return {reinterpret_cast<const char*>(scan.points.data()), scan.points.size() * sizeof(ScanPoint)};
}

TEST(RangeScan, IsTheSameForAnyThreadsAndOrderAndChangesWithTheSeed) {
  Scene scene = make_heap(60, 5);
  scene.air.fog_density = 0.1, scene.air.dust.period = 1;
  LidarFigures lidar;
  lidar.returns = LidarReturns::dual;
  const LidarSpec spec = lidar.spec();
  const LidarPlace place{[](std::int64_t stamp_ns) {
                           return Pose{{}, {-4 + double(stamp_ns - 1'000'000'000) * 1e-9, 0, 1.2}};
                         },
                         1'000'000'000};
  const auto world = std::make_shared<RayWorld>(scene);
  Lidar one(spec, world, place, Medium(scene.air, scene.seed), 3, 1);
  for (int i = 0; i < 3; ++i) one.take(i);
  const RangeScan in_order = one.take(3), alone = scan_of(spec, scene, place, 3, 3);
  ASSERT_GT(in_order.points.size(), 1000u);
  EXPECT_TRUE(bytes_of(in_order) == bytes_of(alone));
  EXPECT_FALSE(bytes_of(alone) == bytes_of(scan_of(spec, scene, place, 3, 3, 4)));
  EXPECT_FALSE(bytes_of(alone) == bytes_of(scan_of(spec, scene, place, 4, 3)));
}

TEST(LidarPattern, OfAVlp16FiresAsItsManualSays) {
  ScanPattern pattern(ideal());
  const std::vector<PatternRay>& rays = pattern.rays(0);
  const int order[] = {0, 8, 1, 9, 2, 10};  // -15, 1, -13, 3, -11, 5 degrees
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(rays[std::size_t(i)].ring, order[i]);
    EXPECT_EQ(rays[std::size_t(i)].offset_ns, 2304 * i);
  }
  EXPECT_EQ(rays[16].offset_ns, 55'296);
  const auto azimuth = [](const PatternRay& r) { return std::atan2(r.direction.y, r.direction.x); };
  EXPECT_NEAR(azimuth(rays[16 * 10]) - azimuth(rays[16 * 11]), 0.1990656 * kPi / 180, 1e-6);  // clockwise
}

// By Ouster's formula: n * (cos e, sin e) + r * direction(e - azimuth_i, altitude_i), turned by 180 degrees and lifted.
TEST(LidarPattern, OfAnOustersMetadataHasItsOwnBeams) {
  const double altitudes[] = {14, 1.5, -17.25}, azimuths[] = {3.5, -1.25, 0.5}, radius = 0.0158, height = 0.0362;
  MissionOptions options;
  options.included.emplace();
  (*options.included)["os.json"] =
      R"({"prod_line":"OS-1","lidar_mode":"512x10","beam_altitude_angles":[14,1.5,-17.25],"beam_azimuth_angles":[3.5,-1.25,0.5],
          "lidar_origin_to_beam_origin_mm":15.8,"lidar_to_sensor_transform":[-1,0,0,0,0,-1,0,0,0,0,1,36.2,0,0,0,1]})";
  const Mission mission = load_mission_text(
      "local top = rubble.read_calibration('os.json').lidar\n"
      "top.noise, top.range_step, top.divergence_mrad, top.min_range, top.range_at_10_percent = false, 0, 0, 0.01, 1000\n"
      "return rubble.mission { lidars = { top = top } }", "m.lua", options);
  SensorSite site;
  site.world_from_sensor = [](double) { return Pose(); };
  site.rays = std::make_shared<RayWorld>(place_boxes({{kRoom, {}}}));
  site.air = std::make_shared<const Medium>(AirSpec(), 1);
  const RangeScan scan = *mission.scenario.sensors.at(0).start(site, 1)->scan(0);
  ASSERT_EQ(scan.points.size(), 3u * 512);
  for (const ScanPoint& p : scan.points) {
    const std::size_t row = 2 - p.ring;
    const double encoder = 2 * kPi * (1 - p.column / 512.0), azimuth = encoder - azimuths[row] * kPi / 180, altitude = altitudes[row] * kPi / 180;
    const Vec3 direction(-std::cos(azimuth) * std::cos(altitude), -std::sin(azimuth) * std::cos(altitude), std::sin(altitude));
    const Vec3 origin(-radius * std::cos(encoder), -radius * std::sin(encoder), height);
    ASSERT_LT(norm(origin + direction * wall_distance(origin, direction, kRoom) - place_of(p)), 1e-5) << p.ring << " " << p.column;
  }
  EXPECT_FALSE(scan.spec->regular);
}

TEST(LidarPattern, OfBeamsThatCannotBeIsRefused) {
  const auto mistake = [](const std::string& keys) {
    try {
      load_mission_text("return rubble.mission { lidars = { top = { " + keys + " } } }", "m.lua");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(mistake("model = 'os1', beam_elevations_deg = { -1, 2 }, beam_azimuths_deg = { 3, 4 }"), "none");
  EXPECT_NE(mistake("model = 'os1', beam_elevations_deg = { 2, -1 }").find("the rings are not in order"), std::string::npos);
  EXPECT_NE(mistake("model = 'os1', beam_azimuths_deg = { 3, 4 }").find("not one for each ring: expected 64, found 2"), std::string::npos);
  EXPECT_NE(mistake("model = 'os1', channels = 32, beam_elevations_deg = { -1, 2 }").find("channels"), std::string::npos);
  EXPECT_NE(mistake("model = 'vlp16', beam_radius = 0.1").find("only the beams of os0, os1 and os2"), std::string::npos);
}

TEST(LidarPattern, OfARosetteFillsTheViewWithTime) {
  ScanPattern pattern(ideal(LidarModel::mid360));
  std::set<std::pair<int, int>> cells;  // of 2 degrees
  std::vector<std::size_t> filled;
  for (const int scans : {1, 5}) {
    for (int i = 0; i < scans; ++i)
      for (const PatternRay& r : pattern.rays(i)) {
        const double elevation = std::asin(r.direction.z) * 180 / kPi;
        ASSERT_GE(elevation, -7 - 1e-9);
        ASSERT_LE(elevation, 52 + 1e-9);
        cells.insert({int(std::floor(std::atan2(r.direction.y, r.direction.x) * 90 / kPi)), int(elevation / 2)});
      }
    filled.push_back(cells.size());
  }
  EXPECT_EQ(pattern.rays(0).size(), 20'000u);
  EXPECT_LT(filled[0], 4000u);
  EXPECT_GT(filled[1], filled[0] * 5 / 4);
}

}  // namespace lidar_test
}  // namespace rubble::testing
