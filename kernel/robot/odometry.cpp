#include "kernel/robot/odometry.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/portable_math.h"
#include "kernel/robot/drive_commands.h"

namespace rubble {
namespace {

constexpr double kStanding = 1e-3;  // slower, slip is no number; unit: m/s

double slip_of(double surface, double ground) {
  return std::abs(surface) < kStanding ? 0 : 1 - ground / surface;
}

double wrapped(double angle) {
  if (angle > portable::kPi) return angle - 2 * portable::kPi;
  return angle < -portable::kPi ? angle + 2 * portable::kPi : angle;
}

double yaw_of(const Quat& rotation) {
  const Vec3 x = rotation.rotate({1, 0, 0});
  return portable::atan2(x.y, x.x);
}

}  // namespace

double OdometryReading::slip_left() const { return slip_of(left, true_left); }
double OdometryReading::slip_right() const { return slip_of(right, true_right); }

WheelOdometry::WheelOdometry(const RobotModel& model, const OdometryNoise& noise)
    : model_(&model), noise_(noise.over_a_metre), random_(noise.seed, "odometry/" + std::to_string(noise.robot)) {}

double WheelOdometry::as_measured(double way) {
  return noise_ > 0 ? way + noise_ * std::sqrt(std::abs(way)) * random_.normal() : way;
}

double WheelOdometry::way_of(const std::vector<int>& side, const RobotState& state, double dt) const {
  double way = 0;
  for (int i : side) {
    const auto at = std::size_t(i);
    double own = model_->sides.belts
                     ? state.links[at].belt_speed * dt
                     : (state.joints[at].position - last_.joints[at].position) * model_->sides.radius;
    for (const SteeredWheel& wheel : model_->sides.steered)  // what of it is along the robot
      if (wheel.driven == i) own *= portable::cos(state.joints[std::size_t(wheel.joint)].position);
    way += own;
  }
  return way / double(side.size());
}

// A car turns as its steering says. It turns by the difference of its sides, as others do, where the middle of its
// curve is between them, or no curve has its wheels at their angles (crab steering).
double WheelOdometry::turn_of(double left, double right, const RobotState& state) const {
  const SideDrive& sides = model_->sides;
  const double by_sides = 0.5 * (right - left) / (0.5 * sides.distance);
  if (sides.steered.empty()) return by_sides;
  double curvature = 0;
  for (const SteeredWheel& wheel : sides.steered)
    curvature += curvature_of(wheel, sides.axle, wheel.sign * state.joints[std::size_t(wheel.joint)].position);
  curvature /= double(sides.steered.size());
  const bool beside = std::abs(curvature) * 0.5 * sides.distance <= 1;  // false of what is not finite
  return beside ? curvature * (0.5 * (left + right)) : by_sides;
}

// First-order propagation along an arc, whose heading is that of its middle.
void WheelOdometry::grow_covariance(double ran_left, double ran_right, double way, double heading) {
  const double error = std::max(noise_, kLeastOdometryError), width = model_->sides.distance;
  const double left = error * error * std::abs(ran_left), right = error * error * std::abs(ran_right);
  const auto [s, c] = portable::sincos(heading);
  auto& p = reading_.covariance;
  // What an error of yaw before it does to the place after it.
  const double fx = -way * s, fy = way * c;
  const double xy = p[0][1], xt = p[0][2], yt = p[1][2], tt = p[2][2];
  p[0][0] += 2 * fx * xt + fx * fx * tt;
  p[0][1] = xy + fy * xt + fx * yt + fx * fy * tt;
  p[1][1] += 2 * fy * yt + fy * fy * tt;
  p[0][2] = xt + fx * tt;
  p[1][2] = yt + fy * tt;
  // What each side adds: d(x, y, yaw) by its way.
  for (const int side : {-1, 1}) {
    const double variance = side < 0 ? left : right, turn = side / width;
    const double g[3] = {0.5 * c - 0.5 * way * s * turn, 0.5 * s + 0.5 * way * c * turn, turn};
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) p[i][j] += variance * g[i] * g[j];
  }
  p[1][0] = p[0][1], p[2][0] = p[0][2], p[2][1] = p[1][2];
  reading_.linear_variance = 0.25 * (left + right), reading_.angular_variance = (left + right) / (width * width);
}

OdometryReading WheelOdometry::update(const RobotState& state, double time) {
  const Pose& base = state.links[0].world_from_link;
  const double yaw = yaw_of(base.rotation), dt = time - time_;
  if (started_ && dt > 0) {
    OdometryReading& r = reading_;
    const double half = 0.5 * model_->sides.distance;
    const double ran_left = way_of(model_->sides.left, state, dt);
    const double ran_right = way_of(model_->sides.right, state, dt);
    const double left = as_measured(ran_left), right = as_measured(ran_right);
    const double way = 0.5 * (left + right), turn = turn_of(left, right, state);
    const auto [s, c] = portable::sincos(r.yaw + 0.5 * turn);
    r.x += way * c, r.y += way * s;
    if (const double axle = model_->sides.axle; axle != 0) {  // the base swings about it
      const auto [s0, c0] = portable::sincos(r.yaw);
      const auto [s1, c1] = portable::sincos(r.yaw + turn);
      r.x -= axle * (c1 - c0), r.y -= axle * (s1 - s0);
    }
    grow_covariance(ran_left, ran_right, way, r.yaw + 0.5 * turn);
    r.yaw = wrapped(r.yaw + turn);
    const double true_turn = wrapped(yaw - true_yaw_);
    const auto [ts, tc] = portable::sincos(true_yaw_ + 0.5 * true_turn);
    const double true_way =
        (base.translation.x - place_.x) * tc + (base.translation.y - place_.y) * ts;
    const double true_left = true_way - true_turn * half, true_right = true_way + true_turn * half;
    slipped_ += std::abs(ran_left - true_left) + std::abs(ran_right - true_right);
    ran_ += std::abs(ran_left) + std::abs(ran_right);
    const double rate = 1 / dt;
    r.linear = way * rate, r.angular = turn * rate;
    r.linear_variance *= rate * rate, r.angular_variance *= rate * rate;
    r.left = left * rate, r.right = right * rate;
    r.true_left = true_left * rate, r.true_right = true_right * rate;
    r.true_linear = true_way * rate, r.true_angular = true_turn * rate;
  }
  started_ = true;
  time_ = time, place_ = base.translation, true_yaw_ = yaw;
  last_ = state;
  return reading_;
}

}  // namespace rubble
