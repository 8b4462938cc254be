#include "scripting/scenario/scenario.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/scripting/test_support.h"

namespace rubble {
namespace scenario_test {

// Every member away from its default.
Scenario unusual() {
  Scenario s;
  s.seed = 9223372036854775807u;
  s.start_ns = 1700000000123456789;
  s.packs = {"a \"quoted\" folder", "b"};
  s.pile.spawn_position = {0.1, -0.2, 1.0 / 3.0};
  s.pile.spawn_bounds = {1e-3, 2, 3};
  s.pile.layers = 0;
  s.pile.pieces_per_layer = 99999;
  s.pile.mix = {{"brick", 0.1, std::nullopt, {}},
                {"slab", 2, std::array<double, 2>{0.5, 0.75}, {Spread::lognormal, 0.6, 0.1}}};
  s.pile.placed = {{"pipe", {1, 2, 3}, {10, 20, 30}, 0.7, false}};
  s.settle.schedule = Schedule::planes;
  s.settle.rest_speed = 0.06;
  s.lights[0].spec.type = LightType::point;
  s.lights[0].random_rotation = true;
  s.air.fog_density = 0.123456789012345678;
  s.cameras[0].camera = {640, 480, 70.5, {"label", "flow"}};
  s.cameras[0].camera.lens = {LensKind::plumb_bob, -0.1, 0.02, 0.001, 0.002, 0.003, 0, 500.5};
  s.cameras[0].camera.stereo_baseline = 0.11;
  s.cameras[0].camera.shutter = {0.015, true, 9};
  s.cameras[0].camera.exposure.mode = ExposureMode::automatic;
  s.cameras[0].camera.sensor.response = Response::linear;
  s.cameras[0].depth_sensor.type = DepthSensorType::time_of_flight;
  s.cameras[0].event_camera.on = true;
  s.lamp.on = false;
  s.trajectory.interpolation = Interpolation::linear;
  s.trajectory.waypoints = {{0.0, std::nullopt, {1, 2, 3}, {1, 0, 0}, Vec3{0, 0, 0}},
                            {std::nullopt, 0.25, {1, 2, 4}, {1, 2, 3}, std::nullopt}};
  s.outputs.rawlog = false;
  s.outputs.depth = DepthEncoding::metres;
  return s;
}

TEST(ScenarioJson, RoundTrips) {
  for (const Scenario& s : {Scenario{}, unusual()}) {
    const std::string json = scenario_to_json(s);
    EXPECT_EQ(scenario_to_json(scenario_from_json(json, "s.json")), json);
  }
  const Scenario back = scenario_from_json(scenario_to_json(unusual()), "s.json");
  EXPECT_EQ(back.seed, 9223372036854775807u);
  EXPECT_EQ(back.start_ns, 1700000000123456789);
  EXPECT_EQ(back.pile.spawn_position, Vec3(0.1, -0.2, 1.0 / 3.0));
  EXPECT_EQ(back.pile.mix[0].scale, std::nullopt);
  EXPECT_EQ(back.trajectory.waypoints[1].speed, 0.25);
  EXPECT_EQ(back.trajectory.waypoints[1].look_at, std::nullopt);
  EXPECT_NE(scenario_to_json(unusual()), scenario_to_json(Scenario{}));
}

TEST(ScenarioJson, NamesEveryMistake) {
  EXPECT_EQ(error_of([] {
              scenario_from_json(R"({"seed": -1, "sede": 2, "pile": {"layers": 2.5}})", "s.json");
            }),
            "s.json: pile.layers: wrong type: expected an integer from 0 to 1000, found 2.5\n"
            "s.json: sede: unknown key `sede` (did you mean `seed`?)\n"
            "s.json: seed: out of range: expected an integer of at least 0, found -1");
  EXPECT_EQ(error_of([] { scenario_from_json("{\n \"seed\": }", "s.json"); }),
            "s.json:2: not valid JSON");
  EXPECT_EQ(error_of([] { scenario_from_json("7", "s.json"); }),
            "s.json: not a scenario: expected an object, found 7");
}

TEST(ScenarioValidate, DefaultAndUnusualAreFine) {
  EXPECT_EQ(error_of([] { Scenario{}.validate(); }), "");
  EXPECT_EQ(error_of([] { unusual().validate(); }), "");
}

TEST(ScenarioValidate, StampsOfRos2EndIn2038) {
  Scenario s;
  s.start_ns = 2147483648000000000;
  EXPECT_EQ(error_of([&] { s.validate(); }), "") << "ROS 1 has them until 2106";
  s.outputs.mcap = true;
  EXPECT_NE(error_of([&] { s.validate(); }).find("start_ns: too late for the stamps of ROS 2"), std::string::npos);
  s.start_ns = 2147483647999999999;
  EXPECT_EQ(error_of([&] { s.validate(); }), "");
}

TEST(ScenarioValidate, FindsEveryMistake) {
  Scenario s;
  s.pile.layers = -1;
  s.pile.spawn_bounds = {1, 0, 1};
  s.pile.mix = {{"a", -1, std::array<double, 2>{2, 1}, {}}};
  s.cameras[0].camera.fov_deg = std::numeric_limits<double>::quiet_NaN();
  s.trajectory.waypoints[0].position.y = std::numeric_limits<double>::infinity();
  EXPECT_EQ(
      error_of([&] { s.validate(); }),
      "pile.spawn_bounds: out of range: expected three numbers {x, y, z}, each above 0, up "
      "to 1000, found {1, 0, 1}\n"
      "pile.layers: out of range: expected an integer from 0 to 1000, found -1\n"
      "pile.mix[1].weight: out of range: expected a number from 0 to 1000000000, found -1\n"
      "pile.mix[1].scale: out of range: expected a number or {min, max}, each from 0.01 to "
      "100, found {2, 1}\n"
      "camera.fov_deg: out of range: expected a number from 1 to 360, found nan\n"
      "trajectory.waypoints[1].position: out of range: expected three numbers {x, y, z}, each "
      "from -1000 to 1000, or a place in a void, found {-9, inf, 4}");
}

TEST(Camera, IntrinsicsFromTheFieldOfView) {
  const Intrinsics in = CameraScenario{1024, 512, 90}.intrinsics();
  EXPECT_EQ(in.width, 1024);
  EXPECT_EQ(in.height, 512);
  EXPECT_NEAR(in.fx, 512, 1e-9);  // tan 45 degrees = 1
  EXPECT_EQ(in.fx, in.fy);
  EXPECT_EQ(in.cx, 511.5);
  EXPECT_EQ(in.cy, 255.5);
  EXPECT_NEAR((CameraScenario{640, 480, 60}.intrinsics().fx), 320 / std::tan(M_PI / 6), 1e-9);
}

TEST(Camera, IntrinsicsOfLenses) {
  CameraScenario camera{1000, 800, 120};
  camera.lens.model = LensKind::fisheye;
  const Intrinsics fisheye = camera.intrinsics();
  EXPECT_EQ(fisheye.lens, LensModel::fisheye);
  EXPECT_NEAR(fisheye.fx, 500 / (M_PI / 3), 1e-9);  // equidistant: r = f theta
  camera.lens.k1 = -0.02;
  EXPECT_NEAR(camera.intrinsics().fx, 500 / (M_PI / 3 * (1 - 0.02 * M_PI * M_PI / 9)), 1e-9);
  camera.lens = {};
  camera.lens.model = LensKind::plumb_bob;
  camera.lens.k1 = 1, camera.lens.k2 = 2, camera.lens.p1 = 3, camera.lens.p2 = 4;
  camera.lens.k3 = 5;
  camera.lens.fx = 610.5;
  camera.lens.cy = 399;
  const Intrinsics k = camera.intrinsics();
  EXPECT_EQ(k.distortion, (std::array<double, 5>{1, 2, 3, 4, 5}));
  EXPECT_EQ(k.fx, 610.5);
  EXPECT_EQ(k.fy, 610.5);
  EXPECT_EQ(k.cx, 499.5);
  EXPECT_EQ(k.cy, 399);
}

TEST(Camera, ContradictionsAreNamed) {
  const auto mistake = [](const auto& spoil) {
    Scenario s;
    spoil(s);
    return error_of([&] { s.validate(); });
  };
  EXPECT_EQ(mistake([](Scenario& s) { s.cameras[0].camera.fov_deg = 180; }),
            "camera.fov_deg: too wide for a flat image: expected at most 170 (or "
            "camera.lens.model = \"fisheye\")");
  EXPECT_EQ(mistake([](Scenario& s) {
              s.cameras[0].camera.fov_deg = 180;
              s.cameras[0].camera.lens.model = LensKind::fisheye;
            }),
            "");
  EXPECT_NE(mistake([](Scenario& s) {
              s.cameras[0].camera.lens.model = LensKind::fisheye;
              s.cameras[0].camera.lens.k1 = -2;
            }).find("folds back"),
            std::string::npos);
  const auto plumb_bob = [&](double k1, double k2, double k3, double fov_deg, std::optional<double> fx = {}) {
    return mistake([&](Scenario& s) {
      CameraScenario& c = s.cameras[0].camera;
      c.fov_deg = fov_deg;
      c.lens.model = LensKind::plumb_bob;
      c.lens.k1 = k1, c.lens.k2 = k2, c.lens.k3 = k3, c.lens.fx = fx;
    });
  };
  EXPECT_NE(plumb_bob(-0.5, 0, 0, 90).find("folds back within the image"), std::string::npos);
  EXPECT_EQ(plumb_bob(-0.5, 0, 0, 50), "");
  EXPECT_EQ(plumb_bob(-0.283, 0.074, 0, 80), "") << "of the EuRoC data set";
  EXPECT_EQ(plumb_bob(0.3, 0, 0, 120), "");
  EXPECT_NE(plumb_bob(0, 0, 0, 90, 1).find("camera.lens.fx: too short"), std::string::npos);
  EXPECT_NE(mistake([](Scenario& s) { s.cameras[0].camera.lens.k1 = 0.1; }).find("no distortion"),
            std::string::npos);
  EXPECT_NE(mistake([](Scenario& s) { s.cameras[0].camera.shutter.motion_blur = true; })
                .find("camera.shutter.motion_blur: an ideal image has no exposure time"),
            std::string::npos);
  EXPECT_NE(mistake([](Scenario& s) { s.cameras[0].depth_sensor.min_range = 7; }).find("the range is empty"),
            std::string::npos);
}

TEST(Light, RandomRotationFollowsTheSeed) {
  Scenario s;
  EXPECT_EQ(resolve_light(s).rpy_deg, s.lights[0].spec.rpy_deg);
  s.lights[0].random_rotation = true;
  const Vec3 first = resolve_light(s).rpy_deg;
  EXPECT_EQ(resolve_light(s).rpy_deg, first);
  for (s.seed = 1; s.seed < 100; ++s.seed) {
    const Vec3 rpy = resolve_light(s).rpy_deg;
    EXPECT_FALSE(rpy == first);
    EXPECT_TRUE(rpy.y >= 20 && rpy.y < 80 && rpy.z >= -180 && rpy.z < 180);
  }
}

}  // namespace scenario_test
}  // namespace rubble
