#include "app/planning/steep_views.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kSteep = 0.2;  // sine of the angle to the vertical
constexpr double kFarTurn = 0.5;  // cosine of the turn from one waypoint to the next
constexpr double kRound = 360;  // unit: degree

double level(const Vec3& d) { return std::sqrt(d.x * d.x + d.y * d.y); }
bool is_steep(const Vec3& d) { return level(d) < kSteep * norm(d); }
double degrees(double radians) { return radians * 180 / portable::kPi; }
double yaw_of(const Vec3& d) { return degrees(portable::atan2(d.y, d.x)); }
double pitch_of(const Vec3& d) { return degrees(portable::atan2(-d.z, level(d))); }

// Of the two directions, and of what is between them on a straight line, the one nearest to the vertical.
Vec3 steepest(const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length2 = way.x * way.x + way.y * way.y;
  const double s = length2 > 0 ? -(a.x * way.x + a.y * way.y) / length2 : 0;
  return a + way * std::min(std::max(s, 0.0), 1.0);
}

// Whether a look that moves on a straight line from one to the other turns unevenly: past the vertical or nearly to the opposite.
bool turns_over(const Vec3& a, const Vec3& b) {
  return is_steep(steepest(a, b)) || dot(a, b) < kFarTurn * norm(a) * norm(b);
}

class SteepViews {
 public:
  SteepViews(const std::vector<bool>& ahead, std::vector<Waypoint>& waypoints) : ahead_(ahead), waypoints_(waypoints) {
    for (const Waypoint& w : waypoints_) views_.push_back(w.look_at ? *w.look_at - w.position : Vec3{});
    for (std::size_t i = 0; i < waypoints_.size(); ++i) steep_.push_back(looks_ahead(i) && is_steep(views_[i]));
  }

  void turn() {
    std::vector<bool> passes = steep_;
    for (std::size_t i = 0; i + 1 < waypoints_.size(); ++i)
      if (waypoints_[i].look_at && waypoints_[i + 1].look_at && turns_over(views_[i], views_[i + 1]))
        passes[i] = passes[i + 1] = true;
    std::vector<double> yaws;
    for (std::size_t i = 0; i < waypoints_.size(); ++i) yaws.push_back(steep_[i] ? yaw_within(i) : yaw_at(i));
    for (std::size_t i = 0; i < waypoints_.size(); ++i) {
      if (!passes[i] || !looks_ahead(i)) continue;
      waypoints_[i].look_at.reset();
      waypoints_[i].rpy_deg = {0, pitch_of(views_[i]), yaws[i]};
    }
  }

 private:
  bool looks_ahead(std::size_t i) const { return ahead_[i] && waypoints_[i].look_at; }

  double yaw_at(std::size_t i) const { return waypoints_[i].look_at ? yaw_of(views_[i]) : waypoints_[i].rpy_deg.z; }

  // Between the yaws before and after the steep part, by the way that is covered; at an end of the whole way, the other one.
  double yaw_within(std::size_t i) const {
    std::size_t first = i, last = i;
    double before = 0, after = 0;
    for (; steep_[first] && first > 0; --first) before += distance(waypoints_[first].position, waypoints_[first - 1].position);
    for (; steep_[last] && last + 1 < waypoints_.size(); ++last)
      after += distance(waypoints_[last].position, waypoints_[last + 1].position);
    if (steep_[first] && steep_[last]) return 0;
    if (steep_[first] || steep_[last]) return yaw_at(steep_[first] ? last : first);
    const double from = yaw_at(first), turn = std::remainder(yaw_at(last) - from, kRound);
    return from + turn * before / (before + after);
  }

  const std::vector<bool>& ahead_;
  std::vector<Waypoint>& waypoints_;
  std::vector<Vec3> views_;   // to what a waypoint looks at
  std::vector<bool> steep_;
};

}  // namespace

void turn_steep_views(const std::vector<bool>& ahead, std::vector<Waypoint>& waypoints) { SteepViews(ahead, waypoints).turn(); }

}  // namespace rubble
