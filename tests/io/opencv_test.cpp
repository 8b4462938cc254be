// Our EXR files through OpenCV's reader, the one behind cv2.imread.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "io/datasets/frames_recorder.h"
#include "io/image/data_picture.h"
#include "tests/io/support.h"

namespace rubble {
namespace opencv_test {

using test::make_full_frame;
using test::ScratchFolder;

cv::Mat read(const std::string& path) {
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 1);
  const cv::Mat image = cv::imread(path, cv::IMREAD_UNCHANGED);
  EXPECT_FALSE(image.empty()) << path;
  return image.isContinuous() ? image : image.clone();
}

// Bit for bit, NaN included; of three channels OpenCV has the last first.
template <typename T>
void expect_same(const cv::Mat& image, const std::vector<T>& expected, int channels) {
  ASSERT_EQ(image.channels(), channels);
  ASSERT_EQ(image.total() * std::size_t(channels), expected.size());
  ASSERT_EQ(image.elemSize1(), sizeof(T));
  const T* found = reinterpret_cast<const T*>(image.data);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::size_t c = i % std::size_t(channels), j = i - c + (std::size_t(channels) - 1 - c);
    ASSERT_EQ(0, std::memcmp(&found[i], &expected[j], sizeof(T))) << i << ": " << found[i] << ", " << expected[j];
  }
}

TEST(OpenCv, ReadsTheNumbersOfEveryExr) {
  ScratchFolder folder;
  auto recorder = make_frames_recorder(folder / "frames", test::full_recording(), 2);
  const Frame frame = make_full_frame(0);
  recorder->write(frame);
  recorder->finish();
  const std::string at = folder / "frames/";
  expect_same(read(at + "depth/000000.exr"), frame.measured_depth, 1);
  expect_same(read(at + "depth_true/000000.exr"), frame.depth, 1);
  expect_same(read(at + "sky_visibility/000000.exr"), frame.get<float>("sky_visibility"), 1);
  expect_same(read(at + "normals/000000.exr"), frame.get<float>("normals"), 3);
  std::vector<float> pieces;
  for (const std::uint32_t id : frame.get<std::uint32_t>("instance")) pieces.push_back(float(std::int32_t(id)));
  expect_same(read(at + "instance/000000.exr"), pieces, 1);
  EXPECT_EQ(std::count(pieces.begin(), pieces.end(), -1.0f), std::count(frame.get<std::uint32_t>("instance").begin(), frame.get<std::uint32_t>("instance").end(), kGroundInstance));
}

// Files that OpenCV writes, by our decoders.
TEST(OpenCv, WritesPicturesThatAreReadAsData) {
  const cv::Mat grey = (cv::Mat_<std::uint8_t>(2, 3) << 0, 50, 100, 150, 200, 255);
  const cv::Mat colour(1, 1, CV_8UC3, cv::Scalar(0, 255, 0));
  const auto written = [](const char* kind, const cv::Mat& image) {
    std::vector<std::uint8_t> file;
    cv::imencode(kind, image, file, {cv::IMWRITE_WEBP_QUALITY, 101});  // 101: without loss
    return decode_data_picture(std::string_view(reinterpret_cast<const char*>(file.data()), file.size()));
  };
  for (const char* kind : {".bmp", ".webp", ".pgm", ".png", ".tif"}) {
    const DataPicture data = written(kind, grey);
    EXPECT_EQ(data.width, 3) << kind;
    EXPECT_EQ(data.values, (std::vector<float>{0, 50, 100, 150, 200, 255})) << kind;
    EXPECT_EQ(data.white, 255) << kind;
    EXPECT_FALSE(data.colour) << kind;
  }
  for (const char* kind : {".bmp", ".webp", ".ppm"}) {
    const DataPicture data = written(kind, colour);
    EXPECT_NEAR(data.values[0], 0.7152 * 255, 1e-3) << kind;
    EXPECT_TRUE(data.colour) << kind;
  }
  const cv::Mat real = (cv::Mat_<float>(2, 1) << -2.5f, 1234.5f);
  EXPECT_EQ(written(".pfm", real).values, (std::vector<float>{-2.5f, 1234.5f}));
}

}  // namespace opencv_test
}  // namespace rubble
