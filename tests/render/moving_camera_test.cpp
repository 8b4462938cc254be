// Motion blur, rolling shutter and stereo pairs against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/devices/software/software_device.h"
#include "tests/render/camera_scenes.h"

namespace rubble::testing {
namespace moving_camera_test {

// Levels of a row as shares of the wall's: the wall is left of the edge.
std::vector<double> profile(const Frame& frame, int row) {
  std::vector<double> out;
  const std::size_t width = std::size_t(frame.intrinsics.width);
  for (std::size_t u = 0; u < width; ++u)
    out.push_back(double(frame.rgb[(std::size_t(row) * width + u) * 3 + 1]));
  return out;
}

// The camera moves 2 m/s to the left past an edge 4 m away, so the image moves to the right by
// f * 2 t / 4: the edge becomes a ramp of that width, its middle where the sharp edge is.
TEST(MotionBlur, IsARampOfTheLengthOfTheMotion) {
  Scene scene = lit_wall();
  scene.light.rpy_deg = {0, 70, 180};  // the wall is dark against an even sky
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  CameraSpec spec = fixed_camera(160, 16, 400);
  spec.exposure.time = 0.06;  // 12 pixels
  spec.exposure.f_number = 36;
  const auto take = [&](bool blur, const auto& pose_at) {
    spec.shutter.motion_blur = blur;
    return Camera(renderer, spec, fly(1, pose_at)).take(0);
  };
  const auto sharp = profile(take(false, sideways), 8), blurred = profile(take(true, sideways), 8);
  const double wall = sharp[40], sky = sharp[120];
  ASSERT_GT(sky, wall + 20);
  ASSERT_LT(sky, 250);
  double area = 0, width = 0;  // of the part between 10 and 90 %
  for (std::size_t u = 0; u < 160; ++u) {
    area += (blurred[u] - sharp[u]) / (wall - sky);
    const double share = (blurred[u] - sky) / (wall - sky);
    width += share > 0.1 && share < 0.9;
  }
  EXPECT_NEAR(area, 0, 0.7) << "the ramp's middle is the sharp edge";
  EXPECT_NEAR(width, 0.8 * 12, 1.2);
  // Direction: nothing is blurred where the motion runs along the edge.
  const auto climbing = [](double t) { return Pose{{}, {0, 0, 2 * t}}; };
  const auto along = profile(take(true, climbing), 8);
  int partly = 0;
  for (const double v : along) {
    const double share = (v - sky) / (wall - sky);
    partly += share > 0.15 && share < 0.85;
  }
  EXPECT_LE(partly, 1);
  EXPECT_EQ(take(true, standing).rgb, take(false, standing).rgb);
}

// Nor is what comes back within the exposure sharp, nor what turns out of the image.
TEST(MotionBlur, IsOfTheWholeWay) {
  Scene scene = lit_wall();
  scene.light.intensity = 3;  // for such a long exposure
  scene.light.rpy_deg = {0, 70, 180};
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  CameraSpec spec = fixed_camera(64, 16, 100);
  spec.exposure.time = 0.8, spec.exposure.f_number = 36, spec.shutter.most_samples = 99;
  const auto differing = [&](const auto& pose_at) {
    std::size_t count = 0;
    std::vector<std::uint8_t> images[2];
    for (const bool blur : {false, true}) {
      spec.shutter.motion_blur = blur;
      images[blur] = Camera(renderer, spec, fly(1, pose_at)).take(0).rgb;
    }
    for (std::size_t i = 0; i < images[0].size(); ++i) count += std::abs(int(images[0][i]) - int(images[1][i])) > 4;
    return double(count) / double(images[0].size());
  };
  const auto back = [](double t) { return Pose{{}, {0, 0.4 * std::cos(2.5 * 3.14159265358979 * t), 0}}; };
  const auto turns = [](double t) { return Pose{Quat{std::cos(1.25 * t), 0, 0, std::sin(1.25 * t)}, {}}; };
  EXPECT_GT(differing(back), 0.1);
  EXPECT_GT(differing(turns), 0.2);
  EXPECT_EQ(differing(standing), 0);
}

// The same edge, but the wall goes to the right at 2 m/s and the camera stands.
TEST(MotionBlur, OfWhatMovesIsARampAsWell) {
  Scene scene = lit_wall();
  scene.light.rpy_deg = {0, 70, 180};
  scene.motion.moving = {0};
  scene.motion.reach.include({4.5, 9, 0});
  scene.motion.reach.include({4.5, 11, 0});
  scene.motion.poses_at = [](std::int64_t stamp_ns) {
    const double t = double(stamp_ns - 5'000'000'000) * 1e-9;  // since the flight's first frame
    return std::vector<std::optional<Pose>>{Pose{{}, {4.5, 10 - 2 * t, 0}}};
  };
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  CameraSpec spec = fixed_camera(160, 16, 400);
  spec.exposure.time = 0.06;  // 12 pixels
  spec.exposure.f_number = 36;
  const auto take = [&](bool blur) {
    spec.shutter.motion_blur = blur;
    return profile(Camera(renderer, spec, fly(1, standing)).take(0), 8);
  };
  const auto sharp = take(false), blurred = take(true);
  const double wall = sharp[40], sky = sharp[120];
  ASSERT_GT(sky, wall + 20);
  double area = 0, width = 0;
  for (std::size_t u = 0; u < 160; ++u) {
    area += (blurred[u] - sharp[u]) / (wall - sky);
    const double share = (blurred[u] - sky) / (wall - sky);
    width += share > 0.1 && share < 0.9;
  }
  EXPECT_NEAR(area, 0, 0.7);
  EXPECT_NEAR(width, 0.8 * 12, 1.2);
}

// Row v is exposed readout * (v / (rows - 1) - 1/2) after the stamp.
TEST(RollingShutter, SkewsByTheReadoutTime) {
  SoftwareDevice device;
  Renderer renderer(device, lit_wall(), plain());
  CameraSpec spec = fixed_camera(160, 120, 400);
  spec.shutter.readout = 0.05;  // 20 pixels
  spec.channels = {find_image_stream("instance")};
  Camera camera(renderer, spec, fly(2, sideways));
  camera.take(0);
  const Frame frame = camera.take(1);
  for (int v = 0; v < 120; v += 17) {
    const double eye = 2 * (0.1 + 0.05 * (v / 119.0 - 0.5));
    const double edge = spec.intrinsics.cx + 400 * eye / 4;
    int first = 0;
    while (first < 160 && instances_of(frame)[std::size_t(v * 160 + first)] == 5) ++first;
    EXPECT_EQ(first, int(std::floor(edge)) + 1) << "row " << v;
  }
}

// With a rolling shutter the flow ends in the row at whose time the point is seen.
TEST(RollingShutter, FlowKeepsToTheRowsOwnTimes) {
  SoftwareDevice device;
  Renderer renderer(device, lit_wall(), plain());
  CameraSpec spec;
  spec.intrinsics = pinhole(160, 120, 200);
  spec.shutter.readout = 0.05;
  spec.channels = {find_image_stream("flow")};
  // Up at 1 m/s: a point of the wall sinks by f / 4 pixels a second.
  const auto climbing = [](double t) { return Pose{{}, {0, 0, t}}; };
  const Frame frame = Camera(renderer, spec, fly(2, climbing)).take(0);
  for (int v = 20; v < 100; v += 13) {
    // v' - v = 50 (0.1 + 0.05 (v' - v) / 119)
    const double expected = 50 * 0.1 / (1 - 50 * 0.05 / 119);
    EXPECT_NEAR(double(flow_of(frame)[std::size_t(v * 160 + 40) * 2 + 1]), expected, 2e-3);
    EXPECT_NEAR(double(flow_of(frame)[std::size_t(v * 160 + 40) * 2]), 0, 2e-3);
  }
}

TEST(Stereo, DisparityIsFocalLengthTimesBaselineOverDepth) {
  SoftwareDevice device;
  for (const ExposureMode mode : {ExposureMode::ideal, ExposureMode::fixed}) {
    Renderer renderer(device, lit_wall(), plain());
    CameraSpec spec = fixed_camera(160, 16, 200);
    spec.exposure.mode = mode;
    spec.exposure.f_number = 16;
    spec.baseline = 0.2;  // 10 pixels at 4 m
    const Frame frame = Camera(renderer, spec, fly(1, standing)).take(0);
    EXPECT_EQ(frame.baseline, 0.2);
    ASSERT_EQ(frame.rgb_right.size(), frame.rgb.size());
    Frame right = frame;
    right.rgb = frame.rgb_right;
    const auto a = profile(frame, 8), b = profile(right, 8);
    const auto edge = [](const std::vector<double>& p) {
      std::size_t best = 1;
      for (std::size_t u = 1; u < p.size(); ++u)
        if (std::fabs(p[u] - p[u - 1]) > std::fabs(p[best] - p[best - 1])) best = u;
      return double(best);
    };
    EXPECT_NEAR(edge(a) - edge(b), 10, 1);
    EXPECT_NEAR(a[30], b[20], 5) << "the same spot of the wall";
  }
}

// The mean column of the light in a row.
double middle_of_light(const std::vector<std::uint8_t>& rgb, int width, int row) {
  double sum = 0, weighted = 0;
  for (int u = 0; u < width; ++u) {
    const double light = double(rgb[std::size_t(row * width + u) * 3 + 1]);
    sum += light, weighted += u * light;
  }
  EXPECT_GT(sum, 0);
  return weighted / sum;
}

// The one lamp of the pair lights one spot of the wall, and each picture has it where that spot is: the
// right one f b / Z further left.
TEST(Stereo, BothPicturesSeeTheSameLamp) {
  Scene scene = lit_wall();
  scene.instances[0].world_from_body.translation.y = 0;
  scene.light.intensity = 0;
  scene.lamp.on = true;
  scene.lamp.position = {0, 0, 0};
  scene.lamp.cone_deg = 12;
  scene.lamp.intensity_cd = 4000;
  SoftwareDevice device;
  for (const ExposureMode mode : {ExposureMode::ideal, ExposureMode::fixed}) {
    Renderer renderer(device, scene, plain());
    CameraSpec spec = fixed_camera(161, 17, 200);
    spec.exposure.mode = mode;
    spec.baseline = 0.4;  // 20 pixels at 4 m
    const Frame frame = Camera(renderer, spec, fly(1, standing)).take(0);
    const double left = middle_of_light(frame.rgb, 161, 8), right = middle_of_light(frame.rgb_right, 161, 8);
    EXPECT_NEAR(left, 80, 1);
    EXPECT_NEAR(left - right, 20, 1);
  }
}

}  // namespace moving_camera_test
}  // namespace rubble::testing
