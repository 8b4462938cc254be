// The table of image streams: complete, consistent, and what single streams hold against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "render/streams/image_streams.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace streams_test {

std::string read(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Streams, HaveEveryFileThatIsWritten) {
  const std::string folder = RUBBLE_SOURCE_DIR "/render/streams/";
  const std::string cmake = read(folder + "CMakeLists.txt");
  const std::size_t begin = cmake.find("set(RUBBLE_STREAMS\n"), end = cmake.find(')', begin);
  ASSERT_NE(end, std::string::npos);
  std::istringstream words(cmake.substr(begin, end - begin));
  std::set<std::string> listed{std::istream_iterator<std::string>(words), {}};
  listed.erase("set(RUBBLE_STREAMS");
  std::set<std::string> written;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().stem().string();
    if (read(file.path().string()).find("ImageStream " + name + "_stream()") != std::string::npos)
      written.insert(name);
  }
  EXPECT_EQ(written, listed) << "a file of render/streams is not in RUBBLE_STREAMS";
  std::set<std::string> named;
  for (const ImageStream& stream : image_streams()) named.insert(stream.name);
  EXPECT_EQ(named, listed) << "a stream has another name than its file";
}

TEST(Streams, AreMadeByTheCameraOrFromWhatIsSeen) {
  for (const ImageStream& stream : image_streams()) {
    EXPECT_EQ(stream.is_truth(), stream.of == nullptr) << stream.name;
    ASSERT_FALSE(stream.meaning.empty());
    EXPECT_EQ(stream.meaning.back(), '.') << stream.name;
    EXPECT_TRUE(stream.components >= 1 && stream.components <= 3) << stream.name;
    EXPECT_EQ(find_image_stream(stream.name), &stream);
  }
  EXPECT_EQ(find_image_stream("norm"), nullptr);
}

// What recorders rely on.
TEST(Streams, HaveFilesThatHoldTheirValues) {
  for (const ImageStream* stream : truth_streams()) {
    const std::size_t value = stream->bytes_per_pixel() / std::size_t(stream->components);
    const bool floats = std::holds_alternative<PixelMaker<float>>(stream->make);
    const int n = stream->components;
    switch (stream->file) {
      case ImageFile::png:
        EXPECT_TRUE((value == 1 && n != 2) || (value == 2 && n == 1)) << stream->name;
        break;
      case ImageFile::flo:
        EXPECT_TRUE(floats && n == 2) << stream->name;
        break;
      case ImageFile::exr:
        EXPECT_EQ(value, 4u) << stream->name;
    }
    EXPECT_FALSE(std::isnan(stream->nothing) && !floats) << stream->name;
  }
}

TEST(Streams, StateSizeAndEncodingOfTheirValues) {
  const auto expect = [](const char* name, std::size_t bytes, const char* encoding) {
    const ImageStream* stream = find_image_stream(name);
    ASSERT_TRUE(stream) << name;
    EXPECT_EQ(stream->bytes_per_pixel(), bytes) << name;
    EXPECT_STREQ(stream->ros_encoding(), encoding) << name;
    const ImageValues blank = stream->blank(6);
    EXPECT_EQ(std::visit([](const auto& v) { return v.size() * sizeof v[0]; }, blank), 6 * bytes);
  };
  expect("normals", 12, "32FC3");
  expect("instance", 4, "32SC1");
  expect("label", 2, "16UC1");
  expect("flow", 8, "32FC2");
  expect("sky_visibility", 4, "32FC1");
  expect("position", 12, "32FC3");
}

// The ground is z = 0; a turned plane has its own equation; both within a float's rounding of the
// distance from the world's origin.
TEST(PositionStream, LiesOnThePlanesThatAreSeen) {
  SoftwareDevice device;
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 64;
  options.texture_size = 16;
  Scene scene;
  scene.meshes.push_back(share(make_box({1, 80, 80})));
  const Quat turn = portable::quat_from_rpy(0.1, -0.2, 0.4);
  scene.instances.push_back({0, 1, {turn, {4, 0, 3}}, 1});
  Renderer renderer(device, scene, options);
  const Intrinsics k = pinhole(64, 48, 40);
  const Pose camera{portable::quat_from_rpy(0, 0.5, 0.1), {-1, 0.3, 1.5}};
  const Frame frame = renderer.view({0, k, camera})
                          .into_frame(0, {find_image_stream("position"), find_image_stream("instance")});
  const auto& points = frame.get<float>("position");
  ASSERT_EQ(points.size(), frame.depth.size() * 3);
  const Vec3 normal = turn.rotate({-1, 0, 0});
  int ground = 0, plane = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const Vec3 p{double(points[i * 3]), double(points[i * 3 + 1]), double(points[i * 3 + 2])};
    const std::uint32_t id = instances_of(frame)[i];
    ASSERT_EQ(std::isnan(p.x), id == kNoInstance);
    if (id == kNoInstance) continue;
    ++(id == kGroundInstance ? ground : plane);
    // The near face of the plane is half a metre in front of its middle.
    const double off = id == kGroundInstance ? p.z : dot(p - Vec3(4, 0, 3), normal) - 0.5;
    ASSERT_NEAR(off, 0, 2e-5) << i;
    // And along the pixel's ray, at the pixel's depth.
    const Vec3 optical = (camera * camera_from_optical).inverse() * p;
    ASSERT_NEAR(optical.z, double(frame.depth[i]), 2e-5);
    ASSERT_NEAR(k.fx * optical.x / optical.z + k.cx, double(i % 64), 2e-3);
  }
  EXPECT_GT(ground, 300);
  EXPECT_GT(plane, 300);
}

}  // namespace streams_test
}  // namespace rubble::testing
