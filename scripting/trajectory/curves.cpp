#include "scripting/trajectory/curves.h"

#include "kernel/base/portable_math.h"

namespace rubble {

Vec3 rotation_vector(const Quat& q) {
  const double sign = q.w < 0 ? -1.0 : 1.0;
  const Vec3 v{sign * q.x, sign * q.y, sign * q.z};
  const double s = norm(v);
  if (s < 1e-12) return 2.0 * v;
  return v * (2.0 * portable::atan2(s, sign * q.w) / s);
}

Quat rotation_by(const Vec3& rotation) {
  const double angle = norm(rotation);
  if (angle < 1e-12)
    return normalized(Quat{1, 0.5 * rotation.x, 0.5 * rotation.y, 0.5 * rotation.z});
  const portable::SinCos half = portable::sincos(0.5 * angle);
  const Vec3 v = rotation * (half.sin / angle);
  return {half.cos, v.x, v.y, v.z};
}

namespace {

// Derivatives at the knots from the mean rate of each leg (Bessel's weights); zero at both ends of
// a leg at rest, so that a pause is one.
std::vector<Vec3> knot_rates(const std::vector<Vec3>& leg_rates, const std::vector<double>& times) {
  const std::size_t legs = leg_rates.size();
  std::vector<Vec3> rates(legs + 1);
  if (legs == 0) return rates;
  for (std::size_t i = 1; i < legs; ++i) {
    const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
    rates[i] = (leg_rates[i - 1] * after + leg_rates[i] * before) * (1.0 / (before + after));
  }
  rates[0] = legs == 1 ? leg_rates[0] : 1.5 * leg_rates[0] - 0.5 * rates[1];
  rates[legs] = legs == 1 ? leg_rates[0] : 1.5 * leg_rates[legs - 1] - 0.5 * rates[legs - 1];
  for (std::size_t i = 0; i < legs; ++i)
    if (leg_rates[i] == Vec3{}) rates[i] = rates[i + 1] = Vec3{};
  return rates;
}

}  // namespace

VectorCurve::VectorCurve(std::vector<Vec3> points, const std::vector<double>& times,
                         Interpolation how)
    : points_(std::move(points)), times_(times), linear_(how == Interpolation::linear) {
  std::vector<Vec3> rates;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i)
    rates.push_back((points_[i + 1] - points_[i]) * (1.0 / (times[i + 1] - times[i])));
  rates_ = knot_rates(rates, times);
}

Vec3 VectorCurve::at(std::size_t leg, double t) const {
  const double h = times_[leg + 1] - times_[leg], s = (t - times_[leg]) / h;
  const Vec3 &a = points_[leg], &b = points_[leg + 1];
  if (linear_) return a + (b - a) * s;
  const double r = 1.0 - s;
  return a * (r * r * (1.0 + 2.0 * s)) + b * (s * s * (3.0 - 2.0 * s)) +
         rates_[leg] * (h * s * r * r) - rates_[leg + 1] * (h * s * s * r);
}

// The Hermite polynomials of at(), derived by s; ds/dt is 1 / h.
Vec3 VectorCurve::rate(std::size_t leg, double t) const {
  const double h = times_[leg + 1] - times_[leg], s = (t - times_[leg]) / h, r = 1.0 - s;
  const Vec3 step = points_[leg + 1] - points_[leg];
  if (linear_) return step * (1.0 / h);
  return step * (6.0 * s * r / h) + rates_[leg] * (r * r - 2.0 * s * r) -
         rates_[leg + 1] * (2.0 * s * r - s * s);
}

Vec3 VectorCurve::second(std::size_t leg, double t) const {
  if (linear_) return {};
  const double h = times_[leg + 1] - times_[leg], s = (t - times_[leg]) / h;
  const Vec3 step = points_[leg + 1] - points_[leg];
  return step * (6.0 * (1.0 - 2.0 * s) / (h * h)) + rates_[leg] * ((6.0 * s - 4.0) / h) -
         rates_[leg + 1] * ((2.0 - 6.0 * s) / h);
}

RotationCurve::RotationCurve(std::vector<Quat> rotations, const std::vector<double>& times,
                             Interpolation how)
    : rotations_(std::move(rotations)), times_(times), linear_(how == Interpolation::linear) {
  std::vector<Vec3> rates;
  for (std::size_t i = 0; i + 1 < rotations_.size(); ++i)
    rates.push_back(rotation_vector(rotations_[i].conjugate() * rotations_[i + 1]) *
                    (1.0 / (times[i + 1] - times[i])));
  rates_ = knot_rates(rates, times);
}

RotationCurve::Bezier RotationCurve::bezier(std::size_t leg) const {
  const double h = times_[leg + 1] - times_[leg];
  const Vec3 first = rates_[leg] * (h / 3.0), last = rates_[leg + 1] * (h / 3.0);
  const Quat &a = rotations_[leg], &b = rotations_[leg + 1];
  return {first, rotation_vector((a * rotation_by(first)).conjugate() * (b * rotation_by(-last))), last};
}

Quat RotationCurve::at(std::size_t leg, double t) const {
  const double h = times_[leg + 1] - times_[leg], s = (t - times_[leg]) / h, r = 1.0 - s;
  if (linear_) return s == 0 ? rotations_[leg] : portable::slerp(rotations_[leg], rotations_[leg + 1], s);
  const Bezier z = bezier(leg);
  return normalized(rotations_[leg] * rotation_by(z.first * (1.0 - r * r * r)) *
                    rotation_by(z.middle * (s * s * (3.0 - 2.0 * s))) * rotation_by(z.last * (s * s * s)));
}

// Each factor turns about a fixed axis; what it adds is seen through the factors after it.
Vec3 RotationCurve::angular_velocity(std::size_t leg, double t) const {
  const double h = times_[leg + 1] - times_[leg], s = (t - times_[leg]) / h, r = 1.0 - s;
  if (linear_) return rotation_vector(rotations_[leg].conjugate() * rotations_[leg + 1]) * (1.0 / h);
  const Bezier z = bezier(leg);
  const Quat after_middle = rotation_by(z.last * (s * s * s)).conjugate();
  const Quat after_first = after_middle * rotation_by(z.middle * -(s * s * (3.0 - 2.0 * s)));
  return after_first.rotate(z.first * (3.0 * r * r / h)) +
         after_middle.rotate(z.middle * (6.0 * s * r / h)) + z.last * (3.0 * s * s / h);
}

}  // namespace rubble
