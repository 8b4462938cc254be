#include "scripting/trajectory/time_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kShortest = 1e-9;  // a piece of path that counts as standing still; unit: m
// An entry of the table within which the path turns by more than this is halved, so often at most.
constexpr double kFineTurn = 0.01;  // unit: rad
constexpr int kMostHalvings = 12;
constexpr double kLeastPart = 1e-6;  // of an entry: a corner nearer to an end of it is that end
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * portable::atan2(norm(Vec3{d.x, d.y, d.z}), std::abs(d.w));
}

double angle_between(const Vec3& a, const Vec3& b) {
  return portable::atan2(norm(cross(a, b)), dot(a, b));
}

// From node to node of the path; [i] leads from node i to node i + 1.
struct Steps {
  std::vector<Vec3> ways;           // unit: m
  std::vector<double> turns;        // unit: rad
  std::vector<double> times, ends;  // that were asked for: how long it takes, when it is over; unit: s
  std::vector<bool> parts;          // whether it is a part of an entry
};

struct Node {
  double time;
  Pose pose;
};

class StepMaker {
 public:
  // most_turn_rate: unit: rad/s
  StepMaker(const std::function<Pose(double)>& path, const std::vector<double>& corners, double most_turn_rate, Steps& steps)
      : path_(path), corners_(corners), most_turn_rate_(most_turn_rate), steps_(steps) {}

  // time: from one to the other. An entry within which the path turns too fast is divided at its corners, and where it turns far:
  // the turn would be faster in places than the mean over the entry.
  void add(const Node& from, const Node& to, double time, int halvings = kMostHalvings, bool part = false) {
    const double turn = angle_between(from.pose.rotation, to.pose.rotation);
    const auto corner = std::upper_bound(corners_.begin(), corners_.end(), from.time + kLeastPart * time);
    const bool inside = corner != corners_.end() && *corner < to.time - kLeastPart * time;
    if (turn > most_turn_rate_ * time && (inside || turn > kFineTurn) && halvings > 0) {
      const double when = inside ? *corner : from.time + 0.5 * time;
      const Node middle{when, path_(when)};
      add(from, middle, when - from.time, halvings - 1, true);
      add(middle, to, to.time - when, halvings - 1, true);
      return;
    }
    steps_.ways.push_back(to.pose.translation - from.pose.translation);
    steps_.turns.push_back(turn);
    steps_.times.push_back(time), steps_.ends.push_back(to.time);
    steps_.parts.push_back(part);
  }

 private:
  const std::function<Pose(double)>& path_;
  const std::vector<double>& corners_;
  double most_turn_rate_;
  Steps& steps_;
};

// The highest speed on each way, before changes of speed are looked at; unit: m/s.
std::vector<double> calc_ceilings(const Steps& s, const SpeedLimits& limits) {
  std::vector<double> ceilings;
  for (std::size_t i = 0; i < s.ways.size(); ++i) {
    const double length = norm(s.ways[i]);
    double time = s.times[i];
    if (limits.max_speed) time = std::max(time, length / *limits.max_speed);
    if (limits.max_turn_rate_deg)
      time = std::max(time, s.turns[i] * 180 / (portable::kPi * *limits.max_turn_rate_deg));
    ceilings.push_back(length / time);
  }
  if (!limits.max_acceleration) return ceilings;
  const double sideways = *limits.max_acceleration * std::sqrt(0.5);
  for (std::size_t i = 1; i < s.ways.size(); ++i) {
    const double a = norm(s.ways[i - 1]), b = norm(s.ways[i]);
    if (a < kShortest || b < kShortest) continue;
    const double bend = angle_between(s.ways[i - 1], s.ways[i]) / (0.5 * (a + b));
    if (bend < 1e-9) continue;
    const double most = std::sqrt(sideways / bend);
    ceilings[i - 1] = std::min(ceilings[i - 1], most);
    ceilings[i] = std::min(ceilings[i], most);
  }
  return ceilings;
}

// Bounds how fast the speed changes from one way to the next.
void bound_changes(const Steps& s, double most, bool at_rest, std::vector<double>& speeds) {
  const auto bound = [&](std::size_t from, std::size_t to) {
    const double distance = 0.5 * (norm(s.ways[from]) + norm(s.ways[to]));
    if (distance < kShortest) return;
    speeds[to] = std::min(speeds[to], std::sqrt(speeds[from] * speeds[from] + 2 * most * distance));
  };
  // From rest, the mean speed over the first way is that in its middle.
  const auto bound_end = [&](std::size_t i) {
    if (norm(s.ways[i]) >= kShortest) speeds[i] = std::min(speeds[i], std::sqrt(most * norm(s.ways[i])));
  };
  if (at_rest) bound_end(0), bound_end(speeds.size() - 1);
  for (std::size_t i = 1; i < speeds.size(); ++i) bound(i - 1, i);
  for (std::size_t i = speeds.size(); i-- > 1;) bound(i, i - 1);
}

}  // namespace

TimeScale::TimeScale(const std::function<Pose(double)>& path, const std::vector<double>& corners, double duration,
                     double step, const SpeedLimits& limits, bool at_rest) {
  if (!limits.scales_time() || !(duration > 0)) return;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(duration / step)));
  const double usual = duration / double(count);
  Steps s;
  StepMaker maker(path, corners, limits.max_turn_rate_deg ? *limits.max_turn_rate_deg * portable::kPi / 180 : kNoLimit, s);
  Node before{0, path(0)};
  for (std::size_t i = 1; i <= count; ++i) {
    const Node here{usual * double(i), path(std::min(duration, usual * double(i)))};
    maker.add(before, here, usual);
    before = here;
  }
  std::vector<double> speeds = calc_ceilings(s, limits);
  if (limits.max_acceleration)
    bound_changes(s, *limits.max_acceleration * std::sqrt(0.5), at_rest, speeds);

  asked_.push_back(0), new_.push_back(0);
  for (std::size_t i = 0; i < s.ways.size(); ++i) {
    double time = s.times[i];
    const double length = norm(s.ways[i]);
    if (length > kShortest) time = std::max(time, length / speeds[i]);
    if (limits.max_turn_rate_deg)
      time = std::max(time, s.turns[i] * 180 / (portable::kPi * *limits.max_turn_rate_deg));
    asked_.push_back(s.ends[i]);
    new_.push_back(new_.back() + time);
  }
  const auto mean = [this](std::size_t i) {
    return (asked_[i + 1] - asked_[i]) / (new_[i + 1] - new_[i]);
  };
  rates_.push_back(mean(0));
  for (std::size_t i = 1; i < s.ways.size(); ++i) {
    const double a = mean(i - 1), b = mean(i);
    rates_.push_back(s.parts[i - 1] || s.parts[i] ? std::min(a, b) : 2 * a * b / (a + b));
  }
  rates_.push_back(mean(s.ways.size() - 1));
}

double TimeScale::when(double asked) const {
  double low = 0, high = duration(asked);
  if (new_.empty()) return asked;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle).time < asked ? low : high) = middle;
  }
  return high;
}

AskedTime TimeScale::at(double t) const {
  if (new_.empty()) return {t, 1, 0};
  const auto after = std::upper_bound(new_.begin() + 1, new_.end() - 1, t);
  const auto i = static_cast<std::size_t>(after - new_.begin()) - 1;
  const double h = new_[i + 1] - new_[i], s = std::min(std::max((t - new_[i]) / h, 0.0), 1.0);
  const double way = asked_[i + 1] - asked_[i], r = 1 - s;
  const double a = rates_[i] * h, b = rates_[i + 1] * h;  // per unit of s
  return {asked_[i] + way * s * s * (3 - 2 * s) + a * s * r * r - b * s * s * r,
          (6 * way * s * r + a * r * (1 - 3 * s) + b * s * (3 * s - 2)) / h,
          (6 * way * (1 - 2 * s) + a * (6 * s - 4) + b * (6 * s - 2)) / (h * h)};
}

}  // namespace rubble
