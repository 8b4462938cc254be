#include "kernel/fines/catenary.h"

#include <cmath>
#include <stdexcept>

#include "kernel/base/portable_math.h"

namespace rubble {

double cosh_of(double x) { return 0.5 * (portable::exp(x) + portable::exp(-x)); }

double sinh_of(double x) {
  if (std::fabs(x) > 0.1) return 0.5 * (portable::exp(x) - portable::exp(-x));
  const double y = x * x;  // exp() less exp() would cancel
  return x * (1 + y / 6 * (1 + y / 20 * (1 + y / 42)));
}

Vec3 Catenary::at(double x) const {
  return from + along * x + Vec3(0, 0, a * cosh_of((x - x0) / a) + c);
}

// With r = sqrt(length^2 - rise^2) / span, sinh(u) = r u has one root u > 0; a = span / (2 u), and the lowest
// point is off the middle by a atanh(rise / length).
Catenary hang(const Vec3& from, const Vec3& to, double length) {
  const Vec3 level{to.x - from.x, to.y - from.y, 0};
  const double rise = to.z - from.z;
  Catenary curve;
  curve.from = from, curve.span = norm(level), curve.along = normalized(level);
  const double r = std::sqrt(std::max(0.0, length * length - rise * rise)) / curve.span;
  if (!(curve.span > 0) || !(r > 1)) throw std::invalid_argument("hang: too short for its ends, or upright");
  double low = 0, high = 1;
  while (sinh_of(high) < r * high) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double u = 0.5 * (low + high);
    (sinh_of(u) < r * u ? low : high) = u;
  }
  curve.a = curve.span / (low + high);
  curve.x0 = 0.5 * curve.span - curve.a * 0.5 * portable::log((length + rise) / (length - rise));
  curve.c = -curve.a * cosh_of(-curve.x0 / curve.a);
  return curve;
}

}  // namespace rubble
