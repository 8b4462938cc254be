#include "io/image/scan_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "io/image/lettering.h"

namespace rubble {
namespace {

constexpr double kCell = 0.04;      // edge of a cell of the ground plan; unit: m
constexpr double kFarthest = 20;    // echoes beyond it are not drawn, so that memory is bounded; unit: m
constexpr double kLeastMargin = 1.5;  // about the way of the sensor; unit: m
constexpr double kLeastHeights = 0.4;  // between the lowest and the highest colour; unit: m
const cv::Scalar kFloor(40, 35, 32), kEarlier(112, 104, 98);

double flat_distance(const Vec3& a, const Vec3& b) {
  const double dx = a.x - b.x, dy = a.y - b.y;
  return std::sqrt(dx * dx + dy * dy);
}

std::uint64_t cell_of(const Vec3& p) {
  const auto index = [](double v) { return std::uint64_t(std::uint32_t(std::int32_t(std::floor(v / kCell)))); };
  return index(p.x) << 32 | index(p.y);
}

Vec3 middle_of(std::uint64_t cell) {
  const auto place = [](std::uint64_t v) { return (double(std::int32_t(std::uint32_t(v))) + 0.5) * kCell; };
  return {place(cell >> 32), place(cell), 0};
}

double at_share(std::vector<double> values, double share) {
  const auto n = std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + n, values.end());
  return values[std::size_t(n)];
}

// From low to high. It begins where blue is light enough to be seen.
cv::Mat height_ramp() {
  cv::Mat levels(1, 220, CV_8UC1), colours;
  for (int i = 0; i < levels.cols; ++i) levels.data[i] = std::uint8_t(36 + i);
  cv::applyColorMap(levels, colours, cv::COLORMAP_TURBO);
  return colours;
}

}  // namespace

// Pixels of the world; Y is up.
struct ScanPlan::View {
  double x0, y1, per_metre;
  cv::Point at(const Vec3& p) const {
    return {int(std::floor((p.x - x0) * per_metre)), int(std::floor((y1 - p.y) * per_metre))};
  }
  double bar() const {  // unit: m
    double length = 1;
    while (length * per_metre < 24) length *= length == 2 ? 2.5 : 2;
    return length;
  }
};

void ScanPlan::add(const RangeScan& scan) {
  last_echoes_.clear();
  way_.push_back(scan.world_from_sensor.front().translation);
  for (const ScanPoint& point : scan.points) {
    const Vec3 local{double(point.x), double(point.y), double(point.z)};
    if (dot(local, local) > kFarthest * kFarthest) continue;
    const auto step = std::size_t(double(point.time) * 1e9 / double(RangeScan::kMotionStep));
    const Vec3 echo = scan.world_from_sensor[std::min(step, scan.world_from_sensor.size() - 1)] * local;
    last_echoes_.push_back(echo);
    cells_.emplace(cell_of(echo), way_.size());
  }
}

void ScanPlan::frame(const std::vector<const Moment*>& moments) {
  std::vector<double> distances, heights;
  for (const Moment* moment : moments)
    for (const Vec3& echo : moment->echoes) {
      distances.push_back(flat_distance(echo, way_[moment->scans - 1]));
      heights.push_back(echo.z);
    }
  if (distances.empty()) return;
  const double margin = std::max(kLeastMargin, at_share(distances, 0.85));
  const auto x_less = [](const Vec3& a, const Vec3& b) { return a.x < b.x; };
  const auto y_less = [](const Vec3& a, const Vec3& b) { return a.y < b.y; };
  const auto x = std::minmax_element(way_.begin(), way_.end(), x_less);
  const auto y = std::minmax_element(way_.begin(), way_.end(), y_less);
  x0_ = x.first->x - margin, x1_ = x.second->x + margin;
  y0_ = y.first->y - margin, y1_ = y.second->y + margin;
  low_ = at_share(heights, 0.02), high_ = at_share(heights, 0.98);
  const double lacking = std::max(0.0, kLeastHeights - (high_ - low_));
  low_ -= lacking / 2, high_ += lacking / 2;
}

ScanPlan::View ScanPlan::view(const cv::Size& size) const {
  const double per_metre = std::min(size.width / (x1_ - x0_), size.height / (y1_ - y0_));
  return {(x0_ + x1_) / 2 - size.width / per_metre / 2, (y0_ + y1_) / 2 + size.height / per_metre / 2, per_metre};
}

cv::Mat ScanPlan::draw(const Moment& moment, const cv::Size& size) const {
  cv::Mat plan(size, CV_8UC3, kFloor);
  const View view = this->view(size);
  const auto dot_at = [&plan](const cv::Point& at, const cv::Scalar& ink) {
    cv::rectangle(plan, cv::Rect(at.x, at.y, 2, 2), ink, cv::FILLED);
  };
  for (const auto& [cell, scan] : cells_)  // in no order: all have one colour
    if (scan <= moment.scans) dot_at(view.at(middle_of(cell)), kEarlier);
  for (std::size_t i = 1; i < moment.scans; ++i)
    cv::line(plan, view.at(way_[i - 1]), view.at(way_[i]), kInk, 1, cv::LINE_AA);
  const cv::Mat ramp = height_ramp();
  for (const Vec3& echo : moment.echoes) {
    const double share = std::clamp((echo.z - low_) / (high_ - low_), 0.0, 1.0);
    dot_at(view.at(echo), cv::Scalar(ramp.at<cv::Vec3b>(0, int(share * (ramp.cols - 1)))));
  }
  if (moment.scans > 0) cv::circle(plan, view.at(way_[moment.scans - 1]), 4, kInk, cv::FILLED, cv::LINE_AA);
  const int length = int(view.bar() * view.per_metre);
  cv::rectangle(plan, cv::Rect(8, size.height - 10, length, 3), kInk, cv::FILLED);
  return plan;
}

std::string ScanPlan::heights() const {
  char text[48];
  std::snprintf(text, sizeof text, "%.1f to %.1f m", low_, high_);
  std::replace(text, text + sizeof text, ',', '.');  // whatever the user's locale
  return text;
}

std::string ScanPlan::bar(const cv::Size& size) const {
  return "bar " + std::to_string(int(view(size).bar())) + " m";
}

}  // namespace rubble
