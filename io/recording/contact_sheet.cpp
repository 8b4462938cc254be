#include "io/recording/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "io/base/atomic_file.h"
#include "io/image/image_file.h"
#include "io/image/lettering.h"
#include "io/image/scan_plan.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr int kMargin = 20, kGap = 4, kCaption = 26, kTitle = 52, kLegend = 64;   // unit: pixel
const cv::Scalar kNoReturn(52, 48, 46);

struct Tile {
  int index = 0;
  std::int64_t stamp_ns = 0;
  cv::Mat colour;            // CV_8UC3, B G R
  std::vector<float> depth;  // as large; unit: m; NaN: no return
  ScanPlan::Moment scans;    // of the sensor that scans, if there is one
};

// The mean over the source pixels under each pixel of the tile, in integers.
cv::Mat shrink_colour(const Frame& frame, int width, int height) {
  const int w = frame.intrinsics.width, h = frame.intrinsics.height;
  cv::Mat tile(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    const int y0 = y * h / height, y1 = std::max(y0 + 1, (y + 1) * h / height);
    for (int x = 0; x < width; ++x) {
      const int x0 = x * w / width, x1 = std::max(x0 + 1, (x + 1) * w / width);
      int sum[3] = {0, 0, 0};
      for (int v = y0; v < y1; ++v) {
        const std::uint8_t* row = frame.rgb.data() + 3 * (std::size_t(v) * std::size_t(w));
        for (int u = x0; u < x1; ++u) {
          for (int c = 0; c < 3; ++c) sum[c] += row[3 * u + c];
        }
      }
      const int n = (y1 - y0) * (x1 - x0);
      for (int c = 0; c < 3; ++c) {
        tile.at<cv::Vec3b>(y, x)[2 - c] = static_cast<std::uint8_t>((sum[c] + n / 2) / n);
      }
    }
  }
  return tile;
}

// The depth at the middle of each pixel of the tile: a mean would invent surfaces at edges.
std::vector<float> sample_depth(const Frame& frame, int width, int height) {
  const int w = frame.intrinsics.width, h = frame.intrinsics.height;
  std::vector<float> tile;
  tile.reserve(std::size_t(width) * std::size_t(height));
  for (int y = 0; y < height; ++y) {
    const auto row = std::size_t((2 * y + 1) * h / (2 * height)) * std::size_t(w);
    for (int x = 0; x < width; ++x) {
      tile.push_back(frame.depth[row + std::size_t((2 * x + 1) * w / (2 * width))]);
    }
  }
  return tile;
}

bool is_return(float depth) { return std::isfinite(depth) && depth > 0; }

// A logarithmic scale of depth: near things of a void and far ones outside both show their shape.
struct DepthScale {
  double near = 1, far = 2;  // unit: m; 0 < near < far

  // 0 at `near` and nearer, 1 at `far` and farther. Portable: the sheet is the same everywhere.
  double fraction(double depth) const {
    const double f = portable::log(depth / near) / portable::log(far / near);
    return std::min(1.0, std::max(0.0, f));
  }
  std::uint8_t level(double depth) const {  // 255: near
    return static_cast<std::uint8_t>(255.0 * (1.0 - fraction(depth)) + 0.5);
  }
};

std::string decimal(double value, int places) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", places, value);
  std::replace(text, text + sizeof text, ',', '.');  // whatever the user's locale
  return text;
}

class ContactSheetRecorder : public Recorder {
 public:
  ContactSheetRecorder(const std::string& path, const ContactSheetOptions& options)
      : file_(path), order_(path), options_(options) {
    const int shown = std::min(options.shown, options.total_frames);
    for (int i = 0; i < shown; ++i) {
      chosen_.push_back(shown == 1 ? 0
                                   : static_cast<int>(std::int64_t{i} * (options.total_frames - 1) /
                                                      (shown - 1)));
    }
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    if (!std::binary_search(chosen_.begin(), chosen_.end(), frame.index)) return;
    const int height =
        std::max(1, options_.tile * frame.intrinsics.height / frame.intrinsics.width);
    tiles_.push_back({frame.index, frame.stamp_ns, shrink_colour(frame, options_.tile, height),
                      sample_depth(frame, options_.tile, height), {}});
    if (has_scans()) tiles_.back().scans = plan_.now();
  }

  void write_reading(const Reading& reading) override {
    if (has_scans() && reading.sensor == options_.scanner_number && reading.scan) plan_.add(*reading.scan);
  }

  void finish() override {
    if (order_.count() != options_.total_frames) {
      throw RunError(file_.path() + ": " + std::to_string(options_.total_frames) +
                     " frames were announced and " + std::to_string(order_.count()) + " came");
    }
    std::vector<const ScanPlan::Moment*> moments;
    for (const Tile& tile : tiles_) moments.push_back(&tile.scans);
    plan_.frame(moments);
    cv::Mat rgb;
    cv::cvtColor(draw_sheet(), rgb, cv::COLOR_BGR2RGB);
    file_.write(encode_png(RgbImage{rgb.cols, rgb.rows, {rgb.datastart, rgb.dataend}}, 6));
    file_.commit();
  }

 private:
  bool has_scans() const { return !options_.scanner.empty(); }

  // From the 1st to the 99th percentile of what is shown, and at least from 1 to 1.5.
  DepthScale calc_scale() const {
    std::vector<float> depths;
    for (const Tile& tile : tiles_) {
      std::copy_if(tile.depth.begin(), tile.depth.end(), std::back_inserter(depths), is_return);
    }
    if (depths.empty()) return {};
    std::sort(depths.begin(), depths.end());
    const double near = static_cast<double>(depths[(depths.size() - 1) / 100]);
    const double far = static_cast<double>(depths[(depths.size() - 1) * 99 / 100]);
    return {near, std::max(far, 1.5 * near)};
  }

  // Near is warm, far is cold, no return is grey.
  cv::Mat colour_depth(const Tile& tile, const DepthScale& scale) const {
    cv::Mat levels(tile.colour.size(), CV_8UC1), colours;
    for (std::size_t i = 0; i < tile.depth.size(); ++i) {
      const float d = tile.depth[i];
      levels.data[i] = is_return(d) ? scale.level(static_cast<double>(d)) : std::uint8_t{0};
    }
    cv::applyColorMap(levels, colours, cv::COLORMAP_TURBO);
    for (std::size_t i = 0; i < tile.depth.size(); ++i) {
      if (is_return(tile.depth[i])) continue;
      for (int c = 0; c < 3; ++c) {
        colours.data[3 * i + std::size_t(c)] = static_cast<std::uint8_t>(kNoReturn[c]);
      }
    }
    return colours;
  }

  cv::Mat draw_sheet() const {
    const int columns = std::max(1, std::min<int>(options_.columns, int(tiles_.size())));
    const int rows = (int(tiles_.size()) + columns - 1) / columns;
    const int tile_height = tiles_.empty() ? 0 : tiles_.front().colour.rows;
    const int pictures = has_scans() ? 3 : 2;
    const int pair_width = pictures * options_.tile + (pictures - 1) * kGap, pair_height = tile_height + kCaption;
    cv::Mat sheet(kTitle + rows * (pair_height + kMargin) + kLegend,
                  kMargin + columns * (pair_width + kMargin), CV_8UC3, kPaper);
    put_label(sheet, options_.title, {kMargin, 34}, 0.75, kInk);
    const DepthScale scale = calc_scale();
    for (int i = 0; i < int(tiles_.size()); ++i) {
      draw_pair(sheet, tiles_[std::size_t(i)], scale,
                {kMargin + i % columns * (pair_width + kMargin),
                 kTitle + i / columns * (pair_height + kMargin)});
    }
    draw_legend(sheet, scale, sheet.rows - kLegend);
    return sheet;
  }

  void draw_pair(cv::Mat& sheet, const Tile& tile, const DepthScale& scale, cv::Point at) const {
    const cv::Size size = tile.colour.size();
    tile.colour.copyTo(sheet(cv::Rect(at, size)));
    colour_depth(tile, scale).copyTo(sheet(cv::Rect({at.x + size.width + kGap, at.y}, size)));
    const double seconds = static_cast<double>(tile.stamp_ns - tiles_.front().stamp_ns) * 1e-9;
    const int baseline = at.y + size.height + 18;
    put_label(sheet, "frame " + std::to_string(tile.index), {at.x, baseline}, 0.45, kInk);
    put_label(sheet, "t = " + decimal(seconds, 2) + " s", {at.x + 100, baseline}, 0.45, kFaint);
    if (!has_scans()) return;
    const int left = at.x + 2 * (size.width + kGap);
    plan_.draw(tile.scans, size).copyTo(sheet(cv::Rect({left, at.y}, size)));
    put_label(sheet, options_.scanner + " from above, " + plan_.bar(size), {left, baseline}, 0.45, kInk);
    put_label(sheet, "z " + plan_.heights(), {left + size.width - 120, baseline}, 0.45, kFaint);
  }

  // A bar from near to far with lengths of 1, 2 and 5 below, and what grey means beside it.
  void draw_legend(cv::Mat& sheet, const DepthScale& scale, int top) const {
    const int grey_width = 130, label_width = 90;
    const int left = kMargin + label_width, width = sheet.cols - left - kMargin - grey_width;
    put_label(sheet, "depth (m)", {kMargin, top + 14}, 0.45, kInk);
    cv::Mat ramp(1, width, CV_8UC1), colours;
    for (int x = 0; x < width; ++x) {
      ramp.data[x] = static_cast<std::uint8_t>(255 - x * 255 / std::max(1, width - 1));
    }
    cv::applyColorMap(ramp, colours, cv::COLORMAP_TURBO);
    for (int y = 0; y < 18; ++y) {
      colours.copyTo(sheet(cv::Rect(left, top + y, width, 1)));
    }
    for (const double length : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1., 2., 5., 10., 20., 50., 100.}) {
      if (length < scale.near || length > scale.far) continue;
      const int x = left + static_cast<int>(scale.fraction(length) * (width - 1));
      cv::line(sheet, {x, top + 18}, {x, top + 23}, kInk, 1);
      put_label(sheet,
                decimal(length, length < 0.1 ? 2
                                : length < 1 ? 1
                                             : 0),
                {x - 4, top + 38}, 0.42, kFaint);
    }
    const int grey = left + width + 16;
    cv::rectangle(sheet, cv::Rect(grey, top, 18, 18), kNoReturn, cv::FILLED);
    cv::rectangle(sheet, cv::Rect(grey, top, 18, 18), kFaint, 1);
    put_label(sheet, "no return", {grey + 26, top + 14}, 0.45, kInk);
  }

  AtomicFile file_;
  FrameOrder order_;
  ContactSheetOptions options_;
  std::vector<int> chosen_;  // frame numbers, ascending
  std::vector<Tile> tiles_;
  ScanPlan plan_;
};

void check_range(const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  Diagnostic diagnostic;
  diagnostic.key = std::string("contact sheet: ") + name;
  diagnostic.message = "is out of range";
  diagnostic.expected = "from " + plain_text(low) + " to " + plain_text(high);
  diagnostic.found = plain_text(value);
  throw InputError(diagnostic);
}

bool is_paper(const RgbImage& sheet, int x, int y) {
  const std::uint8_t* const pixel = sheet.rgb.data() + 3 * (std::size_t(y) * std::size_t(sheet.width) + std::size_t(x));
  return pixel[0] == kPaper[2] && pixel[1] == kPaper[1] && pixel[2] == kPaper[0];
}

// Whether nothing is drawn in so many pixels to the right.
bool is_blank(const RgbImage& sheet, int x, int y, int width) {
  for (int i = 0; i < width; ++i)
    if (!is_paper(sheet, x + i, y)) return false;
  return true;
}

RgbImage cut(const RgbImage& sheet, int x, int y, int width, int height) {
  RgbImage tile{width, height, {}};
  for (int row = 0; row < height; ++row) {
    const auto begin = sheet.rgb.begin() + 3 * (std::ptrdiff_t(y + row) * sheet.width + x);
    tile.rgb.insert(tile.rgb.end(), begin, begin + 3 * width);
  }
  return tile;
}

}  // namespace

std::vector<RgbImage> cut_colour_tiles(const RgbImage& sheet) {
  const int tile = ContactSheetOptions().tile, pitch = 2 * tile + kGap + kMargin, bottom = sheet.height - kLegend;
  std::vector<RgbImage> tiles;
  if (sheet.width < kMargin + pitch || (sheet.width - kMargin) % pitch != 0 || bottom <= kTitle) return tiles;
  int height = 0;
  while (kTitle + height < bottom && !is_blank(sheet, kMargin, kTitle + height, tile)) ++height;
  if (height == 0) return tiles;
  for (int y = kTitle; y + height <= bottom; y += height + kCaption + kMargin)
    for (int x = kMargin; x + pitch <= sheet.width; x += pitch)
      if (!is_blank(sheet, x, y, tile)) tiles.push_back(cut(sheet, x, y, tile, height));
  return tiles;
}

std::unique_ptr<Recorder> make_contact_sheet_recorder(const std::string& path,
                                                      const ContactSheetOptions& options) {
  check_range("total_frames", options.total_frames, 1, 1000000000);
  check_range("shown", options.shown, 1, 100);
  check_range("columns", options.columns, 1, 10);
  check_range("tile", options.tile, 64, 2048);
  return std::make_unique<ContactSheetRecorder>(path, options);
}

}  // namespace rubble
