// Depth sensors against the models and papers that their header names, with fixed seeds.
#include "render/sensors/depth_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/devices/software/software_device.h"
#include "tests/render/cached_options.h"
#include "tests/render/depth_scenes.h"

namespace rubble::testing {
namespace depth_sensor_test {

// Khoshelham and Elberink 2012, figure 10 and eq. 10: sigma_Z = 1.425e-5 /cm Z^2, which is 1.4 mm at
// 1 m and 3.6 cm at 5 m.
TEST(StructuredLight, HasTheNoiseOfKhoshelhamAndElberink) {
  const DepthSensor sensor(kinect());
  for (const double z : {1.0, 2.0, 3.5, 5.0}) {
    const Plane plane(640, 48, 586, z, 0);
    const Statistics s = statistics_of(sensor.measure(plane.view()));
    EXPECT_NEAR(s.deviation / (1.425e-3 * z * z), 1, 0.08) << z;
    EXPECT_NEAR(s.mean, z, 0.004 * z * z) << z;
    EXPECT_EQ(s.valid, 1) << z;
  }
}

// The same paper: neighbouring depths are 2.85e-5 /cm Z^2 apart: 7 cm at 5 m.
TEST(StructuredLight, HasTheResolutionOfKhoshelhamAndElberink) {
  CameraSpec spec = kinect();
  spec.depth_sensor.noise = false;
  const DepthSensor sensor(spec);
  const Plane slope(640, 1, 586, 5, 0.5);
  const std::vector<float> depth = sensor.measure(slope.view());
  double before = 0;
  int steps = 0;
  for (const float value : depth) {
    const double z = double(value);
    if (before > 0 && z != before && std::fabs(z - 5) < 0.6) {
      EXPECT_NEAR(std::fabs(z - before) / (2.85e-3 * z * before), 1, 0.01);
      ++steps;
    }
    before = z;
  }
  EXPECT_GT(steps, 5);
}

// What drops out at an edge is the same in every frame without noise, and what is more likely.
TEST(StructuredLight, HasNoDiceWithoutNoise) {
  Plane plane(64, 16, 586, 2, 0);
  for (std::size_t i = 0; i < plane.distances.size(); ++i)
    if (i % 64 >= 32) plane.distances[i] *= 1.5f;
  CameraSpec spec = kinect();
  spec.depth_sensor.noise = false;
  const DepthSensor quiet(spec), noisy(kinect());
  const auto missing = [&](const DepthSensor& sensor, int frame) {
    std::vector<bool> out;
    for (const float z : sensor.measure(plane.view(frame))) out.push_back(std::isnan(z));
    return out;
  };
  EXPECT_EQ(missing(quiet, 0), missing(quiet, 1));
  EXPECT_NE(missing(noisy, 0), missing(noisy, 1));
}

// Nguyen, Izadi and Lovell 2012, at an angle of 60 degrees and 1 m.
TEST(StructuredLight, IsNoisierOnSlantedFaces) {
  const DepthSensor sensor(kinect());
  const double turn = kPi / 3;
  const Plane plane(640, 200, 586, 1, turn);
  const std::vector<float> depth = sensor.measure(plane.view());
  double squares = 0, count = 0;
  for (std::size_t v = 0; v < 200; ++v)
    for (std::size_t u = 318; u < 322; ++u) {
      const std::size_t i = v * 640 + u;
      if (std::isnan(depth[i])) continue;
      const double z = double(plane.distances[i]) * plane.rays.direction(int(u), int(v)).z;
      squares += (double(depth[i]) - z) * (double(depth[i]) - z), ++count;
    }
  EXPECT_GT(count, 500);
  const double tilt = 1e-4 * turn * turn / ((kPi / 2 - turn) * (kPi / 2 - turn));
  const double expected = std::hypot(1.425e-3, tilt);
  EXPECT_NEAR(std::sqrt(squares / count) / expected, 1, 0.12);
}

TEST(StructuredLight, LosesGrazingFacesAndWhatIsOutOfReach) {
  CameraSpec spec = kinect();
  spec.depth_sensor.max_range = 4;
  const DepthSensor sensor(spec);
  EXPECT_EQ(statistics_of(sensor.measure(Plane(64, 48, 60, 5, 0).view())).valid, 0);
  EXPECT_EQ(statistics_of(sensor.measure(Plane(64, 48, 60, 0.3, 0).view())).valid, 0);
  EXPECT_GT(statistics_of(sensor.measure(Plane(64, 48, 60, 3, 0).view())).valid, 0.99);
  const Plane grazing(8, 8, 400, 2, 82 * kPi / 180);
  EXPECT_EQ(statistics_of(sensor.measure(grazing.view())).valid, 0);
}

// A step between two walls: pixels drop out within the correlation window beside it, nowhere else.
TEST(StructuredLight, DropsOutAtEdges) {
  Plane plane(640, 100, 586, 2, 0);
  for (std::size_t i = 0; i < plane.distances.size(); ++i)
    if (i % 640 >= 320) plane.distances[i] *= 1.5f;
  const std::vector<float> depth = DepthSensor(kinect()).measure(plane.view());
  const auto lost = [&](std::size_t u) {
    double n = 0;
    for (std::size_t v = 0; v < 100; ++v) n += std::isnan(depth[v * 640 + u]);
    return n / 100;
  };
  EXPECT_GT(lost(319), 0.5);
  EXPECT_GT(lost(320), 0.5);
  EXPECT_GT(lost(318), 0.2);
  EXPECT_EQ(lost(310), 0);
  EXPECT_EQ(lost(330), 0);
}

// A box before a wall hides a strip of the wall from the projector to the right of the camera: to
// the left of the box, f b (1/z_box - 1/z_wall) pixels wide.
TEST(StructuredLight, HasTheShadowOfItsProjector) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_box({1, 30, 30})));
  scene.meshes.push_back(share(make_box({0.2, 0.5, 0.5})));
  scene.instances.push_back({0, 1, {{}, {3.5, 0, 0}}, 1});   // wall at 3 m
  scene.instances.push_back({1, 1, {{}, {1.1, 0, 0}}, 2});   // box at 1 m
  SoftwareDevice device;
  RenderOptions options = cached_options();
  options.bake = false, options.shadow_size = 64, options.texture_size = 16;
  Renderer renderer(device, scene, options);
  CameraSpec spec = kinect();
  spec.intrinsics = pinhole(320, 40, 293);
  Flight flight;
  flight.stamps_ns = {1};
  flight.world_from_camera = {Pose{}};
  const Frame frame = Camera(renderer, spec, flight).take(0);
  const double width = 293 * 0.075 * (1 / 1.0 - 1 / 3.0);  // 14.6 pixels
  int lost = 0;
  for (std::size_t u = 5; u < 315; ++u) lost += std::isnan(frame.measured_depth[20 * 320 + u]);
  EXPECT_NEAR(lost, width, 5);  // and some of the edge's own
  const double left = 159.5 - 293 * 0.25;  // the box's left edge on the image
  for (int u = int(left) - 3; u > int(left - width) + 3; --u)
    EXPECT_TRUE(std::isnan(frame.measured_depth[std::size_t(20 * 320 + u)])) << u;
  const double right = 159.5 + 293 * 0.25;
  EXPECT_FALSE(std::isnan(frame.measured_depth[std::size_t(20 * 320 + int(right) + 6)]));
  for (const float z : frame.depth) EXPECT_FALSE(std::isnan(z)) << "the clean depth stays";
}

// Lange and Seitz 2001: sigma = L / sqrt(8) sqrt(A + B) / (2 A).
TEST(TimeOfFlight, HasTheNoiseOfLangeAndSeitz) {
  const CameraSpec spec = time_of_flight();
  const DepthSensor sensor(spec);
  const double span = 299792458 / 40e6;
  for (const double z : {0.7, 2.0, 4.0}) {
    const Plane plane(60, 60, 4000, z, 0);  // so narrow that all rays are alike
    const Statistics s = statistics_of(sensor.measure(plane.view()));
    const double a = spec.depth_sensor.signal * 0.4 / (z * z);
    const double sigma = span / std::sqrt(8) * std::sqrt(a + 2e3) / (2 * a);
    EXPECT_NEAR(s.deviation / sigma, 1, 0.05) << z;
    EXPECT_NEAR(s.mean, z, 4 * sigma / 60 + 1e-4) << z;
  }
}

TEST(TimeOfFlight, WrapsAtHalfAWavelengthAndLosesWeakReturns) {
  CameraSpec spec = time_of_flight();
  spec.depth_sensor.noise = false;
  spec.depth_sensor.signal = 1e6;
  const double span = 299792458 / 40e6;  // 7.49 m
  EXPECT_NEAR(statistics_of(DepthSensor(spec).measure(Plane(8, 8, 4000, 9, 0).view())).mean,
              9 - span, 1e-3);
  spec.depth_sensor.least_amplitude = 60;
  spec.depth_sensor.signal = 1e3;  // 1e3 * 0.4 / 25 = 16 electrons
  EXPECT_EQ(statistics_of(DepthSensor(spec).measure(Plane(8, 8, 4000, 5, 0).view())).valid, 0);
  spec.depth_sensor.signal = 2e4;
  spec.depth_sensor.step = 0.05;
  EXPECT_NEAR(statistics_of(DepthSensor(spec).measure(Plane(8, 8, 4000, 3.02, 0).view())).mean, 3,
              1e-5);
}

TEST(TimeOfFlight, FliesBetweenTheSurfacesOfAnEdge) {
  CameraSpec spec = time_of_flight();
  spec.depth_sensor.noise = false;
  Plane plane(64, 8, 4000, 2, 0);
  for (std::size_t i = 0; i < plane.distances.size(); ++i)
    if (i % 64 >= 32) plane.distances[i] *= 1.5f;
  const std::vector<float> depth = DepthSensor(spec).measure(plane.view());
  const std::size_t row = 4 * 64;
  EXPECT_NEAR(depth[row + 30], 2, 1e-3);
  EXPECT_GT(depth[row + 31], 2.02f);
  EXPECT_LT(depth[row + 32], 2.98f);
  EXPECT_GT(depth[row + 32], depth[row + 31]);
  EXPECT_NEAR(depth[row + 33], 3, 1e-3);
}

// Toelgyessy et al. 2021, Sensors 21(2) 413: at most 17 mm up to 3.5 m.
TEST(TimeOfFlight, DefaultsHaveTheNoiseThatWasMeasuredOfAzureKinect) {
  const DepthSensor sensor(time_of_flight());
  const double far = statistics_of(sensor.measure(Plane(60, 60, 4000, 3.5, 0).view())).deviation;
  EXPECT_NEAR(far, 0.017, 0.001);
  EXPECT_LT(statistics_of(sensor.measure(Plane(60, 60, 4000, 2, 0).view())).deviation, 0.01);
}

TEST(DepthSensor, FollowsTheSeedAndTheFrameButNotTheThreads) {
  const Plane plane(64, 48, 60, 2, 0.2);
  CameraSpec spec = kinect();
  const auto measure = [&](int frame) { return DepthSensor(spec).measure(plane.view(frame)); };
  const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
      return x == y || (std::isnan(x) && std::isnan(y));
    });
  };
  const auto first = measure(0);
  spec.threads = 2;
  EXPECT_TRUE(same(first, measure(0)));
  EXPECT_FALSE(same(first, measure(1)));
  spec.seed = 6;
  EXPECT_FALSE(same(first, measure(0)));
}

// The deviation of what a time-of-flight sensor measures on a wall 3 m away, as a share of what
// theory says for an albedo.
double noise_on(const char* look, double stated, double albedo) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_box({1, 30, 30}, look)));
  scene.instances.push_back({0, 1, {{}, {3.5, 0, 0}}, 1});
  SoftwareDevice device;
  RenderOptions options = cached_options();
  options.bake = false, options.shadow_size = 64, options.texture_size = 16;
  Renderer renderer(device, scene, options);
  CameraSpec spec = time_of_flight();
  spec.depth_sensor.reflectance = stated;
  spec.intrinsics = pinhole(60, 60, 4000);
  Flight flight;
  flight.stamps_ns = {1};
  flight.world_from_camera = {Pose{}};
  const Frame frame = Camera(renderer, spec, flight).take(0);
  const double a = spec.depth_sensor.signal * albedo / 9;
  const double sigma = 299792458 / 40e6 / std::sqrt(8) * std::sqrt(a + 2e3) / (2 * a);
  return statistics_of(frame.measured_depth).deviation / sigma;
}

TEST(TimeOfFlight, SeesEachSurfaceByItsOwnAlbedo) {
  // Means of red in render/materials/surface_appearance.cpp; upright walls hold no dust.
  EXPECT_NEAR(noise_on("drywall", 0, 0.59), 1, 0.05);
  EXPECT_NEAR(noise_on("brick", 0, 0.26), 1, 0.05);
  EXPECT_NEAR(noise_on("brick", 0.59, 0.59), 1, 0.05) << "a stated reflectance counts for all";
}

TEST(IdealDepthSensor, OnlyHasLimits) {
  CameraSpec spec;
  spec.depth_sensor.type = DepthSensorType::ideal;
  spec.depth_sensor.min_range = 1.9, spec.depth_sensor.max_range = 2.1;
  const Plane plane(64, 48, 60, 2, 0.5);
  const std::vector<float> depth = DepthSensor(spec).measure(plane.view());
  int kept = 0;
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const std::size_t i = std::size_t(v * 64 + u);
      const double z = double(plane.distances[i]) * plane.rays.direction(u, v).z;
      EXPECT_EQ(std::isnan(depth[i]), z < 1.9 || z > 2.1);
      if (std::isnan(depth[i])) continue;
      EXPECT_NEAR(depth[i], z, 1e-6);
      ++kept;
    }
  EXPECT_GT(kept, 200);
}

}  // namespace depth_sensor_test
}  // namespace rubble::testing
