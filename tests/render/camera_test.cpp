// The camera's stages against closed forms: exposure, noise, vignette, response, lag.
#include "render/sensors/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/base/portable_math.h"
#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/sensors/exposure_control.h"
#include "render/sensors/image_sensor.h"
#include "render/sensors/noise_field.h"
#include "tests/render/camera_scenes.h"

namespace rubble::testing {
namespace camera_test {

TEST(Camera, WithEveryStageOffIsTheRenderer) {
  const Scene scene = make_heap(60, 2);
  SoftwareDevice device;
  const Flight flight = fly(3, [](double t) { return look_at({5 - t, 1, 1.4}, {0, 0, 0.5}); });
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 48, 40);
  Renderer one(device, scene, plain()), two(device, scene, plain());
  Camera camera(one, spec, flight);
  for (int i = 0; i < camera.frames(); ++i) {
    const Frame a = camera.take(i);
    const Frame b = two.render(flight.world_from_camera[std::size_t(i)], spec.intrinsics, i,
                               flight.stamps_ns[std::size_t(i)]);
    EXPECT_EQ(a.rgb, b.rgb);
    EXPECT_EQ(0, std::memcmp(a.depth.data(), b.depth.data(), a.depth.size() * sizeof(float)));
    EXPECT_EQ(a.stamp_ns, b.stamp_ns);
    EXPECT_EQ(a.exposure_s, 0);
    EXPECT_TRUE(a.measured_depth.empty() && a.rgb_right.empty() && a.events.empty());
  }
}

// A card draws the next frame while one is read.
TEST(Camera, GivesTheSameFramesWhereADeviceRunsAhead) {
  const Scene scene = make_heap(60, 2);
  GlDevice device;
  const Flight flight = fly(4, [](double t) { return look_at({5 - 12 * t, 1, 1.4}, {0, 0, 0.5}); });
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 48, 40);
  spec.channels = {find_image_stream("flow")};
  for (const double baseline : {0.0, 0.1}) {
    spec.baseline = baseline;
    Renderer renderer(device, scene, plain());
    ASSERT_TRUE(renderer.runs_ahead());
    Camera camera(renderer, spec, flight);
    for (int i = 0; i < camera.frames(); ++i) {
      const Frame frame = camera.take(i);
      Renderer fresh(device, scene, plain());
      const Frame alone = Camera(fresh, spec, flight).take(i);
      EXPECT_TRUE(frame.rgb == alone.rgb && frame.rgb_right == alone.rgb_right) << i << " " << baseline;
      const auto &flow = std::get<std::vector<float>>(frame.truth.at("flow")), &flow_alone = std::get<std::vector<float>>(alone.truth.at("flow"));
      EXPECT_EQ(0, std::memcmp(flow.data(), flow_alone.data(), flow_alone.size() * sizeof(float))) << i << " " << baseline;
      EXPECT_EQ(0, std::memcmp(frame.depth.data(), alone.depth.data(), alone.depth.size() * sizeof(float)));
      EXPECT_EQ(frame.rgb_right.empty(), baseline == 0);
    }
  }
}

// A real camera follows what it has seen, and its light comes from several images.
TEST(Camera, FollowsTheLightWhereADeviceRunsAhead) {
  const Scene scene = make_heap(60, 2);
  GlDevice device;
  const Flight flight = fly(5, [](double t) { return look_at({5 - 12 * t, 1, 1.4}, {0, 0, 0.5}); });
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 48, 40);
  spec.exposure.mode = ExposureMode::automatic;
  Renderer renderer(device, scene, plain()), other(device, scene, plain());
  Camera camera(renderer, spec, flight);
  Flight first = flight;  // a camera that does not know where it goes next
  first.stamps_ns.resize(1), first.world_from_camera.resize(1);
  Camera blind(other, spec, first);
  for (int i = 0; i < camera.frames(); ++i) {
    if (i > 0) blind.fly_on(flight.stamps_ns[std::size_t(i)], flight.world_from_camera[std::size_t(i)]);
    const Frame frame = camera.take(i), alone = blind.take(i);
    EXPECT_TRUE(frame.rgb == alone.rgb) << i;
    EXPECT_EQ(frame.exposure_s, alone.exposure_s) << i;
  }
  spec.exposure.mode = ExposureMode::fixed, spec.exposure.time = 0.02, spec.shutter.motion_blur = true;
  Renderer blurred(device, scene, plain());
  Camera moving(blurred, spec, flight);
  for (int i = 0; i < moving.frames(); ++i) {
    const Frame frame = moving.take(i);
    Renderer fresh(device, scene, plain());
    EXPECT_TRUE(frame.rgb == Camera(fresh, spec, flight).take(i).rgb) << i;
  }
}

// From noon's open sky into the dark of a box and back, once a second: each frame is that of a camera
// that never saw another one.
TEST(Camera, AnIdealExposureMetersTheFrameItself) {
  Scene scene = make_heap(60, 2);
  scene.meshes.push_back(share(make_box({4, 4, 0.2}, "concrete_cast")));
  const std::uint32_t slab = std::uint32_t(scene.meshes.size() - 1);
  scene.instances.push_back({slab, 1, {{}, {30, 0, 1.5}}, 900});
  SoftwareDevice device;
  const auto pose = [](double t) {
    return std::lround(t * 10) % 2 ? look_at({29.5, 0, 0.6}, {30.5, 0.2, 0.3})
                                   : look_at({5, 1, 1.4}, {0, 0, 0.5});
  };
  const Flight flight = fly(4, pose);
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 48, 40);
  RenderOptions options = plain();
  options.bake = true, options.bake_rays = 16;
  Renderer one(device, scene, options);
  Camera camera(one, spec, flight);
  for (int i = 0; i < camera.frames(); ++i) {
    const Frame frame = camera.take(i);
    Renderer fresh(device, scene, options);
    EXPECT_EQ(frame.rgb, Camera(fresh, spec, flight).take(i).rgb) << i;
    int white = 0;
    for (const std::uint8_t c : frame.rgb) white += c >= 250;
    EXPECT_LT(white, 0.5 * double(frame.rgb.size())) << i;
  }
}

// The right camera of a pair stands where the left one does: the same picture, if it is exposed alike.
TEST(Camera, BothEyesShareOneExposure) {
  const Scene scene = make_heap(60, 2);
  SoftwareDevice device;
  const Flight flight = fly(4, [](double t) { return look_at({5 - 12 * t, 1 + t, 1.4}, {0, 9 * t, 0.5}); });
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 48, 40);
  spec.baseline = 1e-9;  // nothing but the exposure can differ
  Renderer renderer(device, scene, plain());
  Camera camera(renderer, spec, flight);
  for (int i = 0; i < camera.frames(); ++i) {
    const Frame frame = camera.take(i);
    ASSERT_EQ(frame.rgb.size(), frame.rgb_right.size());
    // Dither is of the image: the last bit may differ, and a few pixels at edges.
    int differ = 0;
    for (std::size_t k = 0; k < frame.rgb.size(); ++k)
      differ += std::abs(int(frame.rgb[k]) - int(frame.rgb_right[k])) > 1 ? 1 : 0;
    EXPECT_LT(differ, 0.02 * double(frame.rgb.size())) << i;
  }
}

// A camera that is moved by a nanometre gives the same picture; the next image of it has other noise.
TEST(Camera, NoiseIsOfTheImageAndThePixelNotOfThePose) {
  const Scene scene = make_heap(60, 2);
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 48, 40);
  const auto take = [&](double shift, int index) {
    return Camera(renderer, spec, fly(3, [&](double) { return look_at({5 + shift, 1, 1.4}, {0, 0, 0.5}); })).take(index).rgb;
  };
  const auto count_different = [](const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) pixels += a[i] != b[i] || a[i + 1] != b[i + 1] || a[i + 2] != b[i + 2];
    return pixels;
  };
  const auto first = take(0, 0);
  EXPECT_EQ(first, take(0, 0));
  EXPECT_LT(count_different(first, take(1e-9, 0)), 64u * 48 / 100);
  EXPECT_LT(count_different(first, take(-1e-12, 0)), 64u * 48 / 100);
  EXPECT_GT(count_different(first, take(0, 1)), 64u * 48 / 20) << "the same noise in each image would be a landmark";
  // Noise of 8 bits is about a level; in the dark, where sRGB is steep, a few.
  const auto second = take(0, 1);
  std::size_t strong = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const int step = std::abs(int(first[i]) - int(second[i]));
    strong += step > 4;
    ASSERT_LE(step, 12) << i;
  }
  EXPECT_LT(strong, first.size() / 500);
}

// Mean of an 8-bit linear image, without clipped pixels to spoil it.
double mean_of(const Frame& frame) {
  double sum = 0;
  for (const std::uint8_t c : frame.rgb) sum += c;
  EXPECT_LT(*std::max_element(frame.rgb.begin(), frame.rgb.end()), 255);
  return sum / double(frame.rgb.size());
}

TEST(Exposure, IsLinearInTimeAndSpeedAndAreaOfTheAperture) {
  SoftwareDevice device;
  Renderer renderer(device, lit_wall(), plain());
  const auto level = [&](double time, double iso, double f_number) {
    CameraSpec spec = fixed_camera(32, 32, 200);
    spec.intrinsics.cx += 200;  // only the wall
    spec.exposure.time = time, spec.exposure.iso = iso, spec.exposure.f_number = f_number;
    const Frame frame = Camera(renderer, spec, fly(1, standing)).take(0);
    EXPECT_EQ(frame.exposure_s, time);
    return mean_of(frame);
  };
  const double one = level(0.0001, 100, 4);
  EXPECT_GT(one, 5);
  EXPECT_NEAR(level(0.0002, 100, 4) / one, 2, 0.05);
  EXPECT_NEAR(level(0.0001, 300, 4) / one, 3, 0.05);
  EXPECT_NEAR(level(0.0001, 100, 2) / one, 4, 0.05);
}

// ISO 12232: at speed S a grey of L = 78 N^2 / (0.65 S t) just saturates.
TEST(Exposure, SaturatesWhereTheStandardSays) {
  const double luminance = 78 * 4.0 / (0.65 * 200 * 0.01) / 1000;  // kcd/m2
  EXPECT_NEAR(saturation_share({0.01, 200}, 2) * luminance, 1, 1e-12);
  CameraSpec spec = fixed_camera(4, 4, 4);
  const LensDirections ahead(16, Vec3f(0, 0, 1));
  spec.exposure.f_number = 2;
  const ImageSensor sensor(spec, ahead);
  const auto at = [&](double share) {
    return sensor.count(std::vector<float>(48, float(luminance * share)), {0.01, 200}, 0, 0)[0];
  };
  EXPECT_EQ(at(1.01), sensor.most());
  EXPECT_NEAR(at(0.5), 0.5 * sensor.most(), 1);
  EXPECT_EQ(at(0), 0);
}

struct Moments {
  double mean = 0, variance = 0;
};
template <typename T>
Moments moments_of(const std::vector<T>& values) {
  Moments m;
  for (const T v : values) m.mean += double(v) / double(values.size());
  for (const T v : values)
    m.variance += (double(v) - m.mean) * (double(v) - m.mean) / double(values.size() - 1);
  return m;
}

TEST(NoiseField, HasTheMomentsOfItsDistributions) {
  const NoiseField field(11, "test");
  constexpr std::uint64_t kCount = 200000;
  std::vector<double> values(kCount);
  for (std::uint64_t i = 0; i < kCount; ++i) values[i] = field.normal(i);
  EXPECT_NEAR(moments_of(values).mean, 0, 0.01);
  EXPECT_NEAR(moments_of(values).variance, 1, 0.015);
  for (const double mean : {0.3, 4.0, 29.0, 31.0, 800.0}) {
    for (std::uint64_t i = 0; i < kCount; ++i) values[i] = field.poisson(i, mean);
    EXPECT_NEAR(moments_of(values).mean, mean, 5 * std::sqrt(mean / double(kCount))) << mean;
    EXPECT_NEAR(moments_of(values).variance / mean, 1, 0.03) << mean;
  }
  EXPECT_NE(NoiseField(11, "test", 1).normal(0), field.normal(0));
  EXPECT_NE(NoiseField(12, "test").normal(0), field.normal(0));
}

// Also of a register that is not full, and where few and many photons stand side by side.
TEST(NoiseField, IsTheSameBitsInLanes) {
  const NoiseField field(7, "lanes", 3);
  std::vector<std::uint32_t> places;
  std::vector<double> means;
  RandomStream random(5, "means");
  for (std::uint32_t i = 0; i < 40001; ++i) {
    places.push_back(i < 20000 ? i : std::uint32_t(random.below(std::uint64_t(1) << 32)));
    means.push_back(i % 7 == 0 ? 0 : i % 11 == 0 ? -1 : 30 * std::pow(10, random.uniform(-6, 6)));
  }
  means[1] = 30, means[2] = std::nextafter(30, 31), means[3] = 5e-324, means[4] = std::nan(""), means[5] = 1e300;
  for (const NoiseLanes& lanes : noise_lanes())
    for (const std::size_t count : {std::size_t(0), std::size_t(1), std::size_t(13), places.size()}) {
      std::vector<double> normal(count), poisson(count);
      field.normal(places.data(), count, normal.data(), lanes);
      field.poisson(places.data(), means.data(), count, poisson.data(), lanes);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(normal[i], field.normal(places[i])) << lanes.name << ", place " << places[i];
        ASSERT_EQ(poisson[i], field.poisson(places[i], means[i])) << lanes.name << ", mean " << means[i];
      }
    }
}

// The photon transfer curve: variance = mean + read^2 + step^2 / 12, in electrons.
TEST(Noise, FollowsThePhotonTransferCurve) {
  CameraSpec spec = fixed_camera(200, 200, 100);
  spec.sensor = {true, 8000, 6, 12, 0, Response::linear, 2.2};
  const LensDirections ahead(200 * 200, Vec3f(0, 0, 1));
  const ImageSensor sensor(spec, ahead);
  for (const double iso : {100.0, 400.0}) {
    const ExposureSettings settings{0.01, iso};
    const double well = 8000 * 100 / iso, step = well / sensor.most();
    for (const double share : {0.02, 0.1, 0.4, 0.8}) {
      const float light = float(share / saturation_share(settings, spec.exposure.f_number));
      const auto counts = sensor.count(std::vector<float>(200 * 200 * 3, light), settings, 7, 0);
      const Moments m = moments_of(counts);
      const double mean = m.mean * step, variance = m.variance * step * step;
      EXPECT_NEAR(mean, share * well, 0.01 * share * well + 0.1);
      EXPECT_NEAR(variance / (share * well + 36 + step * step / 12), 1, 0.03) << iso << " " << share;
    }
  }
}

TEST(Noise, FollowsTheSeedTheFrameAndTheEye) {
  CameraSpec spec = fixed_camera(16, 16, 16);
  spec.sensor.noise = true;
  const std::vector<float> light(16 * 16 * 3, 0.1f);
  const LensDirections ahead(16 * 16, Vec3f(0, 0, 1));
  const auto draw = [&](std::uint64_t seed, int threads, int frame, int eye) {
    spec.seed = seed, spec.threads = threads;
    return ImageSensor(spec, ahead).count(light, {0.01, 100}, frame, eye);
  };
  const auto first = draw(1, 1, 0, 0);
  EXPECT_EQ(first, draw(1, 2, 0, 0));
  EXPECT_NE(first, draw(2, 1, 0, 0));
  EXPECT_NE(first, draw(1, 1, 1, 0));
  EXPECT_NE(first, draw(1, 1, 0, 1));
}

TEST(Vignette, FallsWithTheFourthPowerOfTheCosine) {
  CameraSpec spec = fixed_camera(101, 1, 50);
  const auto directions = make_lens_directions(spec.intrinsics, 1);
  const std::vector<float> light(303, 0.1f);
  const auto even = ImageSensor(spec, *directions).count(light, {0.01, 100}, 0, 0);
  spec.sensor.vignette = 1;
  const auto fallen = ImageSensor(spec, *directions).count(light, {0.01, 100}, 0, 0);
  EXPECT_EQ(fallen[150], even[150]);  // the middle
  EXPECT_NEAR(double(fallen[0]) / even[0], std::pow(std::cos(portable::kPi / 4), 4), 1e-3);
}

// A lens that sees behind itself has no fall-off there unless it is asked for.
TEST(Vignette, OfNothingLeavesWhatIsBehindTheLens) {
  CameraSpec spec = fixed_camera(3, 1, 1);
  const LensDirections directions{{0, 0, 1}, {1, 0, 0}, {0.5f, 0, -0.866f}};
  const std::vector<float> light(9, 0.1f);
  spec.sensor.vignette = 0;
  const ImageSensor even(spec, directions);
  const auto counts = even.count(light, {0.01, 100}, 0, 0);
  EXPECT_GT(counts[0], 0);
  for (const auto count : counts) EXPECT_EQ(count, counts[0]);
  spec.sensor.vignette = 1;
  const auto fallen = ImageSensor(spec, directions).count(light, {0.01, 100}, 0, 0);
  EXPECT_EQ(fallen[0], counts[0]);
  EXPECT_EQ(fallen[fallen.size() - 1], 0);
}

TEST(Response, IsTheStandardsCurve) {
  CameraSpec spec = fixed_camera(1, 1, 1);
  spec.sensor.bits = 10;
  const LensDirections ahead(1, Vec3f(0, 0, 1));
  const auto at = [&](Response response, double share) {
    spec.sensor.response = response;
    return ImageSensor(spec, ahead).develop({std::uint16_t(std::lround(share * 1023))})[0];
  };
  EXPECT_EQ(at(Response::linear, 0.5), 128);
  EXPECT_EQ(at(Response::srgb, 0.5), 188);   // IEC 61966-2-1: 0.7354
  EXPECT_EQ(at(Response::srgb, 0.18), 118);  // 0.4614
  EXPECT_EQ(at(Response::gamma, 0.5), 186);  // 0.5^(1/2.2) = 0.7297
  EXPECT_EQ(at(Response::srgb, 1), 255);
}

// A step of light by 8: with the time constant tau the error in stops shrinks by exp(-dt / tau).
TEST(AutoExposure, LagsBehindTheLight) {
  ExposureSpec spec;
  spec.mode = ExposureMode::automatic;
  spec.time_constant = 0.2, spec.delay = 0, spec.longest_time = 1;
  ExposureControl control(spec);
  const double before = 0.18;  // share of saturation at the first exposure
  control.settle([&](double factor) { return before * factor; });
  const double start = std::log2(control.settings().time);
  std::vector<double> error;
  for (int i = 0; i < 10; ++i) {
    const double exposure = std::log2(control.settings().time) - start;
    error.push_back(-3 - exposure);  // the light is 8 times brighter now
    control.follow(std::min(1.0, before * 8 * std::exp2(exposure)), 0.1);
  }
  EXPECT_NEAR(error[0], -3, 1e-6);
  // While the image is clipped the meter sees too little; then it follows the exponential.
  for (std::size_t i = 4; i < 9; ++i)
    EXPECT_NEAR(error[i + 1] / error[i], std::exp(-0.1 / 0.2), 0.01) << i;
  EXPECT_GT(std::fabs(error[1]), 1);  // still overexposed in the next frame
}

TEST(AutoExposure, RaisesTimeFirstThenSpeedAndEndsThere) {
  ExposureSpec spec;
  spec.mode = ExposureMode::automatic;
  spec.time_constant = 0, spec.delay = 0;
  spec.longest_time = 0.02, spec.highest_iso = 800;
  ExposureControl control(spec);
  for (int i = 0; i < 3; ++i) control.follow(0.09, 0.1);
  EXPECT_EQ(control.settings().time, 0.02);
  EXPECT_NEAR(control.settings().iso, 400, 1e-6);
  for (int i = 0; i < 9; ++i) control.follow(0.001, 0.1);
  EXPECT_NEAR(control.settings().iso, 800, 1e-6);
  for (int i = 0; i < 9; ++i) control.follow(1, 0.1);
  EXPECT_LT(control.settings().time, 0.02);
  EXPECT_EQ(control.settings().iso, 100);
}

TEST(AutoExposure, KeepsALongestTimeThatIsShort) {
  ExposureSpec spec;
  spec.mode = ExposureMode::automatic;
  spec.time_constant = 0, spec.delay = 0, spec.longest_time = 2e-6;
  ExposureControl control(spec);
  for (const double mean : {1.0, 0.0, 1.0}) {
    for (int i = 0; i < 9; ++i) control.follow(mean, 0.1);
    EXPECT_LE(control.settings().time, 2e-6);
  }
}

// A camera that turns from a dark wall to the sky: the first frames after the turn are too bright.
TEST(AutoExposure, LeavesFramesOverexposedAfterASuddenChange) {
  Scene scene = lit_wall();
  scene.light.rpy_deg = {0, 30, 180};  // the wall's face lies in the shade
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  CameraSpec spec = fixed_camera(32, 32, 100);
  spec.exposure = {};
  spec.exposure.mode = ExposureMode::automatic;
  spec.sensor.response = Response::srgb;
  const auto turning = [](double t) {
    return Pose{portable::quat_from_rpy(0, 0, t < 0.25 ? 0.6 : -0.8), {0, 1, 0}};
  };
  Camera camera(renderer, spec, fly(12, turning));
  std::vector<double> means;
  for (int i = 0; i < 12; ++i) {
    double sum = 0;
    const Frame frame = camera.take(i);
    for (const std::uint8_t c : frame.rgb) sum += c;
    means.push_back(sum / double(frame.rgb.size()));
  }
  EXPECT_NEAR(means[0], means[2], 3) << "settled before the first frame";
  EXPECT_GT(means[3], means[2] + 30);
  EXPECT_LT(std::fabs(means[11] - means[2]), 12);
}

}  // namespace camera_test
}  // namespace rubble::testing
