#include "io/image/drive_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/image/lettering.h"
#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

constexpr int kBar = 48, kLine = 20;         // below the panes; unit: pixel
constexpr double kNear = 0.2, kFar = 20;     // of the colours of depth; unit: m
constexpr double kLetters = 0.42;
const cv::Scalar kTrack(60, 160, 255), kCamera(60, 60, 255), kNoReturn(46, 48, 52);

cv::Mat colour_pane(const Frame& frame) {
  const cv::Mat rgb(frame.intrinsics.height, frame.intrinsics.width, CV_8UC3,
                    const_cast<std::uint8_t*>(frame.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

// On a logarithmic scale from red (near) to blue (far): near things of a void and far ones outside
// both show their shape.
cv::Mat depth_pane(const Frame& frame) {
  const int width = frame.intrinsics.width, height = frame.intrinsics.height;
  cv::Mat levels(height, width, CV_8UC1), nothing(height, width, CV_8UC1), colours;
  for (int i = 0; i < width * height; ++i) {
    const float depth = frame.depth[std::size_t(i)];
    const bool seen = std::isfinite(depth) && depth > 0;
    const double share = seen ? quick::log(depth / kNear) / quick::log(kFar / kNear) : 1;
    levels.data[i] = std::uint8_t(255 * (1 - std::clamp(share, 0.0, 1.0)));
    nothing.data[i] = seen ? 0 : 255;
  }
  cv::applyColorMap(levels, colours, cv::COLORMAP_TURBO);
  colours.setTo(kNoReturn, nothing);
  return colours;
}

cv::Point pixel(const std::array<double, 2>& p) {
  return {int(std::lround(p[0])), int(std::lround(p[1]))};
}

cv::Mat map_pane(const DrivePicture& picture) {
  const RgbImage& map = *picture.map;
  const cv::Mat rgb(map.height, map.width, CV_8UC3, const_cast<std::uint8_t*>(map.rgb.data()));
  cv::Mat pane;
  cv::cvtColor(rgb, pane, cv::COLOR_RGB2BGR);
  for (std::size_t i = 1; i < picture.track.size(); ++i)
    cv::line(pane, pixel(picture.track[i - 1]), pixel(picture.track[i]), kTrack, 1, cv::LINE_AA);
  if (picture.track.empty()) return pane;
  const std::array<double, 2> here = picture.track.back(), d = picture.heading;
  const std::array<double, 2> tip{here[0] + 16 * d[0], here[1] + 16 * d[1]};
  cv::line(pane, pixel(here), pixel(tip), kCamera, 2, cv::LINE_AA);
  cv::circle(pane, pixel(here), 4, kCamera, -1, cv::LINE_AA);
  return pane;
}

void put_words(cv::Mat& pane, const std::string& text, cv::Point origin) {
  put_label(pane, text, origin + cv::Point(1, 1), kLetters, cv::Scalar(0, 0, 0));
  put_label(pane, text, origin, kLetters, kInk);
}

void put_help(cv::Mat& pane, const DrivePicture& picture) {
  if (picture.help.empty()) return;
  pane *= 0.3;
  // As much as fits: rows are what, keys, gamepad.
  const double size = std::min(kLetters, kLetters * pane.cols / 520.0);
  const int line = std::max(9, std::min(kLine, (pane.rows - 30) / int(picture.help.size())));
  int y = 24 + line;
  for (const auto& row : picture.help) {
    put_label(pane, row[0], {8, y}, size, kInk);
    put_label(pane, row[1], {8 + pane.cols * 31 / 100, y}, size, kInk);
    put_label(pane, row[2], {8 + pane.cols * 63 / 100, y}, size, kFaint);
    y += line;
  }
}

// Below the name of the pane; not where help covers it.
void put_legend(cv::Mat& pane, const DrivePicture& picture) {
  if (!picture.help.empty()) return;
  int y = picture.map ? 16 + kLine : 16;
  for (const PictureLabel& row : picture.legend) {
    put_label(pane, row.text, cv::Point(9, y + 1), kLetters, cv::Scalar(0, 0, 0));
    put_label(pane, row.text, cv::Point(8, y), kLetters, cv::Scalar(row.colour[2], row.colour[1], row.colour[0]));
    y += kLine;
  }
}

}  // namespace

std::array<int, 2> drive_picture_size(int frame_width, int frame_height) {
  return {2 * frame_width + frame_height, frame_height + kBar};
}

std::array<int, 2> inspect_picture_size(int frame_width, int frame_height) {
  return {frame_width, frame_height + kBar};
}

RgbImage draw_drive_picture(const DrivePicture& picture) {
  const Frame& frame = *picture.frame;
  const int width = frame.intrinsics.width, height = frame.intrinsics.height;
  const std::array<int, 2> size = picture.map ? drive_picture_size(width, height) : inspect_picture_size(width, height);
  cv::Mat sheet(size[1], size[0], CV_8UC3, kPaper);
  cv::Mat colour = colour_pane(frame);
  for (const PictureLine& line : picture.lines)
    cv::line(colour, pixel(line.from), pixel(line.to), cv::Scalar(line.colour[2], line.colour[1], line.colour[0]), 1, cv::LINE_AA);
  put_help(colour, picture);
  if (!picture.notice.empty()) put_words(colour, picture.notice, {8, height - 10});
  put_legend(colour, picture);
  if (picture.map) {
    cv::Mat depth = depth_pane(frame), map = map_pane(picture);
    put_words(colour, "colour", {8, 16});
    put_words(depth, "depth, red 0.2 m to blue 20 m", {8, 16});
    put_words(map, "map", {8, 16});
    depth.copyTo(sheet(cv::Rect(width, 0, width, height)));
    map.copyTo(sheet(cv::Rect(2 * width, 0, height, height)));
  }
  colour.copyTo(sheet(cv::Rect(0, 0, width, height)));
  for (std::size_t i = 0; i < picture.status.size(); ++i)
    put_label(sheet, picture.status[i], {8, height + 18 + int(i) * kLine}, kLetters,
              i == 0 ? kInk : kFaint);
  RgbImage image{size[0], size[1], std::vector<std::uint8_t>(std::size_t(size[0] * size[1]) * 3)};
  cv::Mat rgb(size[1], size[0], CV_8UC3, image.rgb.data());
  cv::cvtColor(sheet, rgb, cv::COLOR_BGR2RGB);
  return image;
}

}  // namespace rubble
