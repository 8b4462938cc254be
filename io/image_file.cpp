#include "io/image_file.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/atomic_file.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

void write_encoded(const std::string& path, const cv::Mat& pixels, int level) {
  std::vector<unsigned char> bytes;
  try {
    if (!cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, level})) {
      throw RunError("cannot encode " + path + " as PNG");
    }
  } catch (const cv::Exception& error) {
    throw RunError("cannot encode " + path + " as PNG: " + error.what());
  }
  AtomicFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

[[noreturn]] void refuse(const std::string& path, const char* message, const char* expected) {
  Diagnostic diagnostic;
  diagnostic.file = path;
  diagnostic.message = message;
  diagnostic.expected = expected;
  throw InputError(diagnostic);
}

cv::Mat read_decoded(const std::string& path, int type, const char* expected) {
  const std::string bytes = read_whole_file(path);
  cv::Mat pixels;
  if (!bytes.empty()) {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1,
                          const_cast<char*>(bytes.data()));
    pixels = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  }
  if (pixels.empty()) refuse(path, "cannot be read as a picture", expected);
  if (pixels.type() != type) refuse(path, "has the wrong kind of pixels", expected);
  return pixels;
}

}  // namespace

void write_png(const std::string& path, const RgbImage& image, int level) {
  const cv::Mat rgb(image.height, image.width, CV_8UC3,
                    const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  write_encoded(path, bgr, level);
}

void write_png(const std::string& path, const DepthImage& image, int level) {
  const cv::Mat depth(image.height, image.width, CV_16UC1,
                      const_cast<std::uint16_t*>(image.values.data()));
  write_encoded(path, depth, level);
}

RgbImage read_rgb_png(const std::string& path) {
  const cv::Mat bgr = read_decoded(path, CV_8UC3, "a PNG of 8-bit red, green and blue");
  cv::Mat rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return {rgb.cols, rgb.rows, {rgb.datastart, rgb.dataend}};
}

DepthImage read_depth_png(const std::string& path) {
  const cv::Mat depth = read_decoded(path, CV_16UC1, "a PNG of one 16-bit channel");
  const auto* first = depth.ptr<std::uint16_t>();
  return {depth.cols, depth.rows, {first, first + depth.total()}};
}

}  // namespace rubble
