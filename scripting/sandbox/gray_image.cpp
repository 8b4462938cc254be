#include "scripting/sandbox/gray_image.h"

#include <png.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace rubble {
namespace {

constexpr int kLargestSide = 256;                 // of what is kept; unit: pixel
constexpr std::uint64_t kMostPixels = 16'000'000;  // of the file

struct Bytes {
  int columns, rows;
  std::vector<png_byte> values;
};

Bytes decode(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto check = [&image](bool fine) {
    if (fine) return;
    const std::string reason = image.message;
    png_image_free(&image);
    throw std::runtime_error("not a readable PNG file: " + reason);
  };
  check(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) != 0);
  if (std::uint64_t(image.width) * image.height > kMostPixels) {
    png_image_free(&image);
    throw std::runtime_error("the image has more than 16 million pixels");
  }
  image.format = PNG_FORMAT_GRAY;
  Bytes gray{int(image.width), int(image.height), {}};
  gray.values.resize(PNG_IMAGE_SIZE(image));
  const png_color black{};  // stands behind what is transparent
  check(png_image_finish_read(&image, &black, gray.values.data(), 0, nullptr) != 0);
  return gray;
}

}  // namespace

bool is_png(const std::string& bytes) { return bytes.rfind("\x89PNG", 0) == 0; }

std::string png_to_pgm(const std::string& bytes) {
  const Bytes image = decode(bytes);
  const int block = (std::max(image.columns, image.rows) + kLargestSide - 1) / kLargestSide;
  const int columns = (image.columns + block - 1) / block, rows = (image.rows + block - 1) / block;
  std::ostringstream text;
  text << "P2\n" << columns << " " << rows << "\n255\n";
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      int sum = 0, count = 0;
      for (int y = r * block; y < std::min(image.rows, (r + 1) * block); ++y)
        for (int x = c * block; x < std::min(image.columns, (c + 1) * block); ++x, ++count)
          sum += image.values[std::size_t(y) * std::size_t(image.columns) + std::size_t(x)];
      text << (c > 0 ? " " : "") << (2 * sum + count) / (2 * count);
    }
    text << "\n";
  }
  return text.str();
}

GrayGrid parse_pgm(const std::string& text) {
  std::istringstream in(text);
  std::string magic;
  GrayGrid image;
  int most = 0;
  in >> magic >> image.columns >> image.rows >> most;
  if (!in || magic != "P2" || image.columns < 1 || image.rows < 1 || most < 1 ||
      image.columns > kLargestSide || image.rows > kLargestSide)
    throw std::runtime_error("not a PNG file");
  for (int i = 0; i < image.columns * image.rows; ++i) {
    int value = 0;
    if (!(in >> value) || value < 0 || value > most) throw std::runtime_error("not a whole image");
    image.values.push_back(double(value) / most);
  }
  return image;
}

}  // namespace rubble
