#include "io/voids/void_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

const cv::Scalar kInk(50, 45, 40), kPaper(252, 251, 249), kArrow(40, 40, 215);
constexpr int kMargin = 24, kHeader = 44, kFooter = 84;

// A perceptually even scale from deep blue by teal to pale yellow, linear between its stops (BGR).
cv::Vec3b colour_of(double t) {
  static const double kStops[6][3] = {{94, 38, 49},   {140, 84, 46},  {140, 131, 38},
                                      {120, 176, 70}, {88, 212, 158}, {60, 232, 250}};
  t = std::clamp(t, 0.0, 1.0) * 5;
  const int k = std::min(4, int(t));
  cv::Vec3b c;
  for (int i = 0; i < 3; ++i)
    c[i] = std::uint8_t(kStops[k][i] + (kStops[k + 1][i] - kStops[k][i]) * (t - k) + 0.5);
  return c;
}

std::string text_of(double value, int places) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", places, value);
  return text;
}

void put_text(cv::Mat& sheet, const std::string& text, cv::Point at, double size = 0.5) {
  cv::putText(sheet, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

// The cells that are shown: around the voids of a robot, or all where there are none.
struct Window {
  Cell first{0, 0, 0}, last{0, 0, 0};  // inclusive

  int size(std::size_t axis) const { return last[axis] - first[axis] + 1; }
};

Window find_window(const VoxelGrid& grid, const RobotVoids& robot, double margin) {
  Window w;
  w.last = {grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1};
  if (robot.voids.empty()) return w;
  Cell low = w.last, high = w.first;
  for (const Void& v : robot.voids) {
    for (const std::uint32_t i : v.cells) {
      const Cell c = grid.cell(i);
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], c[k]);
        high[k] = std::max(high[k], c[k]);
      }
    }
  }
  const int more = int(std::ceil(margin / grid.voxel));
  for (std::size_t k = 0; k < 3; ++k) {
    w.first[k] = std::max(0, low[k] - more);
    w.last[k] = std::min(w.last[k], high[k] + more);
  }
  return w;
}

// A drawing whose pixels are cells, to be enlarged and put on a sheet with title and legend.
class Sheet {
 public:
  // width, height: of the drawing in cells; voxel: of a cell; unit: m
  Sheet(int width, int height, double voxel, int long_side)
      : cells_(height, width, CV_8UC3, kPaper),
        voxel_(voxel),
        scale_(std::max(1.0, double(long_side) / std::max(width, height))) {}

  cv::Vec3b& at(int x, int y) { return cells_.at<cv::Vec3b>(y, x); }

  void enlarge() {
    cv::Mat large;
    cv::resize(cells_, large, {}, scale_, scale_, cv::INTER_NEAREST);
    sheet_ = cv::Mat(large.rows + kHeader + kFooter, std::max(large.cols + 2 * kMargin, 640),
                     CV_8UC3, kPaper);
    large.copyTo(sheet_(cv::Rect(kMargin, kHeader, large.cols, large.rows)));
    cv::rectangle(sheet_, cv::Rect(kMargin - 1, kHeader - 1, large.cols + 2, large.rows + 2),
                  cv::Scalar(190, 185, 180));
  }

  // Coordinates in cells, from the upper left.
  cv::Point place(double x, double y) const {
    return {kMargin + int(x * scale_), kHeader + int(y * scale_)};
  }

  // With an empty label it is small and thin.
  void arrow(double x, double y, double dx, double dy, const std::string& label) {
    const double length = quick::hypot(dx, dy), reach = label.empty() ? 16 : 40;
    const int width = label.empty() ? 1 : 2;
    if (x < 0 || y < 0 || x >= cells_.cols || y >= cells_.rows) return;
    const cv::Point tip = place(x, y);
    if (length > 0.2) {
      const cv::Point tail(tip.x - int(dx / length * reach), tip.y - int(dy / length * reach));
      cv::arrowedLine(sheet_, tail, tip, cv::Scalar(255, 255, 255), width + 3, cv::LINE_AA, 0,
                      0.35);
      cv::arrowedLine(sheet_, tail, tip, kArrow, width, cv::LINE_AA, 0, 0.35);
      write(label, {tail.x - 6, tail.y - 6});
    } else {
      cv::circle(sheet_, tip, 2 + 2 * width, kArrow, width, cv::LINE_AA);
      write(label, {tip.x + 8, tip.y - 6});
    }
  }

  void outline(const cv::Mat& mask) {
    cv::Mat large;
    cv::resize(mask, large, {}, scale_, scale_, cv::INTER_NEAREST);
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(large, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE, {kMargin, kHeader});
    cv::drawContours(sheet_, contours, -1, cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
  }

  // A bar of a round length, a colour scale from 0 to `top` metres, and the title.
  RgbImage finish(const std::string& title, const std::string& scale_name, double top) {
    put_text(sheet_, title, {kMargin, 28}, 0.55);
    const int y = sheet_.rows - kFooter + 30;
    const double pixels_per_metre = scale_ / voxel_;
    double bar = 0.1;
    for (const double step : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0})
      if (step * pixels_per_metre < 220) bar = step;
    const int length = int(bar * pixels_per_metre);
    cv::line(sheet_, {kMargin, y}, {kMargin + length, y}, kInk, 3);
    put_text(sheet_, text_of(bar, 1) + " m", {kMargin, y + 24});
    const int left = kMargin + 260, wide = 240;
    for (int i = 0; i < wide; ++i) {
      const cv::Vec3b c = colour_of(double(i) / wide);
      cv::line(sheet_, {left + i, y - 8}, {left + i, y + 4}, cv::Scalar(c[0], c[1], c[2]), 1);
    }
    put_text(sheet_, "0", {left, y + 24});
    put_text(sheet_, text_of(top, 2) + " m " + scale_name, {left + wide - 50, y + 24});
    cv::Mat rgb;
    cv::cvtColor(sheet_, rgb, cv::COLOR_BGR2RGB);
    return {rgb.cols, rgb.rows, {rgb.datastart, rgb.dataend}};
  }

 private:
  void write(const std::string& text, cv::Point at) {
    cv::putText(sheet_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.55, cv::Scalar(255, 255, 255), 4,
                cv::LINE_AA);
    cv::putText(sheet_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.55, kArrow, 1, cv::LINE_AA);
  }

  cv::Mat cells_, sheet_;
  double voxel_, scale_;
};

std::string make_title(const VoidMap& map, std::size_t robot, const std::string& title) {
  const RobotVoids& r = map.robots[robot];
  return (title.empty() ? "" : title + "   ") + "robot radius " + text_of(r.radius, 2) +
         " m: " + std::to_string(r.voids.size()) + " voids, " + text_of(r.volume, 2) +
         " m3, of which " + text_of(r.reachable_volume, 2) + " m3 reachable";
}

// Light from the upper left over the height of the highest solid cell of each column.
double shade(const std::vector<int>& height, const Cell& size, int x, int y) {
  const auto h = [&](int i, int k) {
    i = std::clamp(i, 0, size[0] - 1);
    k = std::clamp(k, 0, size[1] - 1);
    return height[std::size_t(i) + std::size_t(size[0]) * std::size_t(k)];
  };
  const double slope = 0.35 * (h(x + 1, y) - h(x - 1, y)) - 0.35 * (h(x, y + 1) - h(x, y - 1));
  return std::clamp(0.78 + 0.16 * slope / std::sqrt(1 + slope * slope), 0.0, 1.0);
}

std::string label_of(std::size_t rank, const VoidPictureOptions& options) {
  return int(rank) < options.labels ? std::to_string(rank + 1) : "";
}

std::vector<int> find_tops(const VoidSpace& space) {
  const std::size_t layer = std::size_t(space.grid.size[0]) * std::size_t(space.grid.size[1]);
  std::vector<int> tops(layer, 0);
  for (std::size_t i = 0; i < space.kind.size(); ++i)
    if (space.kind[i] == CellKind::solid) tops[i % layer] = int(i / layer) + 1;
  return tops;
}

}  // namespace

RgbImage draw_void_plan(const VoidMap& map, std::size_t robot, const VoidPictureOptions& options) {
  const VoidSpace& space = map.space;
  const Cell& size = space.grid.size;
  const std::vector<int> tops = find_tops(space);
  std::vector<int> open(tops.size(), 0);  // cells that the robot covers, of each column
  for (const Void& v : map.robots[robot].voids)
    for (const std::uint32_t i : v.cells) ++open[i % open.size()];
  const int most = std::max(1, *std::max_element(open.begin(), open.end()));

  const Window w = find_window(space.grid, map.robots[robot], options.margin);
  Sheet sheet(w.size(0), w.size(1), space.grid.voxel, options.long_side);
  for (int y = w.first[1]; y <= w.last[1]; ++y) {
    for (int x = w.first[0]; x <= w.last[0]; ++x) {
      const std::size_t i = std::size_t(x) + std::size_t(size[0]) * std::size_t(y);
      cv::Vec3b& pixel = sheet.at(x - w.first[0], w.last[1] - y);
      const double light = shade(tops, size, x, y);
      if (tops[i] > 0)
        for (int c = 0; c < 3; ++c) pixel[c] = std::uint8_t(255 * (0.62 + 0.38 * light) * light);
      if (open[i] == 0) continue;
      const cv::Vec3b colour = colour_of(double(open[i]) / most);
      for (int c = 0; c < 3; ++c) pixel[c] = std::uint8_t(0.25 * pixel[c] + 0.75 * colour[c]);
    }
  }
  sheet.enlarge();
  for (std::size_t v = map.robots[robot].voids.size(); v-- > 0;) {
    for (const Entrance& e : map.robots[robot].voids[v].entrances) {
      const Vec3 p = (e.position - space.grid.corner) * (1 / space.grid.voxel);
      sheet.arrow(p.x - w.first[0], w.last[1] + 1 - p.y, e.inward.x, -e.inward.y,
                  label_of(v, options));
    }
  }
  return sheet.finish(make_title(map, robot, options.title), "free height",
                      most * space.grid.voxel);
}

RgbImage draw_void_cut(const VoidMap& map, std::size_t robot, int axis, const Vec3& through,
                       const VoidPictureOptions& options) {
  const VoidSpace& space = map.space;
  const VoxelGrid& grid = space.grid;
  const std::size_t across = std::size_t(axis), along = axis == 0 ? 1 : 0;
  const int cut = std::clamp(grid.find_cell(through)[across], 0, grid.size[across] - 1);
  const Window w = find_window(grid, map.robots[robot], options.margin);
  const int width = w.size(along), height = w.last[2] + 1;

  cv::Mat covered(height, width, CV_8UC1, cv::Scalar(0));
  for (const Void& v : map.robots[robot].voids) {
    for (const std::uint32_t i : v.cells) {
      const Cell c = grid.cell(i);
      if (c[across] != cut || c[along] < w.first[along] || c[along] > w.last[along]) continue;
      covered.at<std::uint8_t>(height - 1 - c[2], c[along] - w.first[along]) = 255;
    }
  }
  double widest = 0.05;
  for (int z = 0; z < height; ++z)
    for (int x = 0; x < width; ++x) {
      Cell c{0, 0, z};
      c[across] = cut;
      c[along] = w.first[along] + x;
      const std::size_t i = grid.index(c);
      if (space.kind[i] == CellKind::free_void)
        widest = std::max(widest, double(space.clearance[i]));
    }

  Sheet sheet(width, height, grid.voxel, options.long_side);
  for (int z = 0; z < height; ++z) {
    for (int x = 0; x < width; ++x) {
      Cell c{0, 0, z};
      c[across] = cut;
      c[along] = w.first[along] + x;
      const std::size_t i = grid.index(c);
      cv::Vec3b& pixel = sheet.at(x, height - 1 - z);
      if (space.kind[i] == CellKind::solid)
        pixel = cv::Vec3b(88, 92, 96);
      else if (space.kind[i] == CellKind::outside)
        pixel = cv::Vec3b(244, 240, 234);
      else
        pixel = colour_of(space.clearance[i] / widest);
    }
  }
  sheet.enlarge();
  sheet.outline(covered);
  for (std::size_t v = map.robots[robot].voids.size(); v-- > 0;) {
    for (const Entrance& e : map.robots[robot].voids[v].entrances) {
      const Vec3 p = (e.position - grid.corner) * (1 / grid.voxel);
      if (std::abs(p[int(across)] - cut) * grid.voxel > 0.3) continue;
      sheet.arrow(p[int(along)] - w.first[along], height - p.z, e.inward[int(along)], -e.inward.z,
                  label_of(v, options));
    }
  }
  return sheet.finish(make_title(map, robot, options.title), "clearance", widest);
}

}  // namespace rubble
