#include "io/image/picture_sheet.h"

#include <algorithm>

#include "io/base/atomic_file.h"
#include "io/image/image_file.h"
#include "io/image/lettering.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr int kMargin = 12, kTitle = 40, kCaption = 38;  // unit: pixel
constexpr double kNameSize = 0.42, kNoteSize = 0.36;

constexpr int kJpegQuality = 84;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// A caption within its tile's width: smaller letters rather than fewer.
void put_caption(cv::Mat& sheet, const std::string& text, cv::Point at, double size, int width,
                 const cv::Scalar& colour) {
  const double fits = double(width) / std::max(1, label_width(text, size));
  put_label(sheet, text, at, size * std::min(1.0, fits), colour);
}

cv::Mat as_matrix(const RgbImage& image) {
  cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

void check_picture_name(const std::string& path) {
  for (const char* ending : {".png", ".jpg", ".jpeg"})
    if (ends_with(path, ending)) return;
  const std::size_t dot = path.find_last_of("./");
  const bool has_ending = dot != std::string::npos && path[dot] == '.';
  throw InputError({path, 0, "--out", "the name says no format of pictures", "a file that ends with .png, .jpg or .jpeg",
                    has_ending ? path.substr(dot) : "no ending", ""});
}

void write_picture_sheet(const std::string& path, const std::string& title,
                         const std::vector<SheetTile>& tiles, int columns) {
  const int width = tiles.empty() ? 1 : tiles[0].picture.width;
  const int height = tiles.empty() ? 1 : tiles[0].picture.height;
  columns = std::max(1, std::min(columns, int(tiles.size())));
  const int rows = (int(tiles.size()) + columns - 1) / columns;
  cv::Mat sheet(kTitle + rows * (height + kCaption), kMargin + columns * (width + kMargin), CV_8UC3,
                kPaper);
  put_label(sheet, title, {kMargin, 27}, 0.6, kInk);
  for (int i = 0; i < int(tiles.size()); ++i) {
    const SheetTile& tile = tiles[std::size_t(i)];
    const cv::Point at{kMargin + i % columns * (width + kMargin),
                       kTitle + i / columns * (height + kCaption)};
    as_matrix(tile.picture).copyTo(sheet(cv::Rect(at, cv::Size(width, height))));
    put_caption(sheet, tile.name, {at.x, at.y + height + 14}, kNameSize, width, kInk);
    put_caption(sheet, tile.note, {at.x, at.y + height + 29}, kNoteSize, width, kFaint);
  }
  cv::Mat rgb;
  cv::cvtColor(sheet, rgb, cv::COLOR_BGR2RGB);
  const RgbImage image{rgb.cols, rgb.rows, {rgb.datastart, rgb.dataend}};
  if (!ends_with(path, ".jpg") && !ends_with(path, ".jpeg")) return write_png(path, image, 9);
  AtomicFile file(path);
  file.write(encode_jpeg(image.width, image.height, image.rgb.data(), kJpegQuality));
  file.commit();
}

}  // namespace rubble
