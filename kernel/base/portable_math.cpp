#include "kernel/base/portable_math.h"

#include <cstdint>
#include <cstring>

namespace rubble::portable {
namespace {

// pi/2 in three parts of 33 bits, so that k * part is exact for |k| < 2^20 (Cody and Waite 1980).
constexpr double kHalfPi1 = 0x1.921fb544p+0;
constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;
constexpr double kTwoOverPi = 0.63661977236758134308;

// Taylor series, enough terms for |r| <= pi/4.
double sin_series(double r) {
  const double s = r * r;
  double sum = 1.0;
  for (int k = 17; k >= 3; k -= 2) sum = 1.0 - s / double(k * (k - 1)) * sum;
  return r * sum;
}

double cos_series(double r) {
  const double s = r * r;
  double sum = 1.0;
  for (int k = 18; k >= 2; k -= 2) sum = 1.0 - s / double(k * (k - 1)) * sum;
  return sum;
}

// atan on [0, 1]: two halvings by atan(x) = 2 atan(x / (1 + sqrt(1 + x^2))), then the series.
double atan_unit(double x) {
  double scale = 1.0;
  for (int i = 0; i < 2; ++i, scale *= 2.0) x = x / (1.0 + std::sqrt(1.0 + x * x));
  const double s = x * x;
  double sum = 0.0;
  for (int k = 25; k >= 1; k -= 2) sum = 1.0 / double(k) - s * sum;
  return scale * x * sum;
}

double scale_by_power_of_two(double x, int exponent) {
  const std::uint64_t bits = std::uint64_t(1023 + exponent) << 52;
  double factor;
  std::memcpy(&factor, &bits, sizeof factor);
  return x * factor;
}

}  // namespace

SinCos sincos(double x) {
  const double k = std::floor(x * kTwoOverPi + 0.5);
  const double r = ((x - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
  const double s = sin_series(r), c = cos_series(r);
  switch (std::int64_t(k) & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

double atan2(double y, double x) {
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax == 0.0 && ay == 0.0) return 0.0;
  double angle = ay <= ax ? atan_unit(ay / ax) : kPi / 2 - atan_unit(ax / ay);
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}

double acos(double x) { return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }
double asin(double x) { return atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }

double exp(double x) {
  constexpr double kLog2Hi = 0x1.62e42fefp-1, kLog2Lo = 0x1.473de6af278edp-34;
  const double k = std::floor(x / 0.69314718055994530942 + 0.5);
  const double r = (x - k * kLog2Hi) - k * kLog2Lo;
  double sum = 1.0;
  for (int n = 15; n >= 1; --n) sum = 1.0 + r / double(n) * sum;
  const int half = int(k) / 2;  // in two steps, so that neither power leaves the normal range
  return scale_by_power_of_two(scale_by_power_of_two(sum, half), int(k) - half);
}

double log(double x) {
  int exponent;
  double m = std::frexp(x, &exponent);  // exact
  if (m < 0.70710678118654752440) m *= 2.0, --exponent;
  const double f = (m - 1.0) / (m + 1.0), s = f * f;
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = 1.0 / double(k) + s * sum;
  return double(exponent) * 0.69314718055994530942 + 2.0 * f * sum;
}

Quat quat_from_rpy(double roll, double pitch, double yaw) {
  const SinCos r = sincos(roll * 0.5), p = sincos(pitch * 0.5), y = sincos(yaw * 0.5);
  const Quat qx{r.cos, r.sin, 0, 0}, qy{p.cos, 0, p.sin, 0}, qz{y.cos, 0, 0, y.sin};
  return normalized(qz * qy * qx);
}

Vec3 rpy_from_quat(const Quat& rotation) {
  constexpr double kSteep = 1e-8;  // below it, rounding turns roll and yaw by more than leaving yaw out; unit: 1
  const Mat3 r = rotation.matrix();
  const double level = std::sqrt(r.rows[0].x * r.rows[0].x + r.rows[1].x * r.rows[1].x);
  const double pitch = atan2(-r.rows[2].x, level);
  if (level < kSteep) return {atan2(-r.rows[1].z, r.rows[1].y), pitch, 0};
  return {atan2(r.rows[2].y, r.rows[2].z), pitch, atan2(r.rows[1].x, r.rows[0].x)};
}

Quat slerp(const Quat& a, const Quat& b, double t) {
  double c = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  const double sign = c < 0.0 ? -1.0 : 1.0;
  c *= sign;
  double wa = 1.0 - t, wb = t;
  if (c < 0.9999) {  // below that, the straight blend differs by less than 1e-9 rad
    const double angle = acos(c), inverse = 1.0 / sin(angle);
    wa = sin((1.0 - t) * angle) * inverse;
    wb = sin(t * angle) * inverse;
  }
  wb *= sign;
  return normalized(Quat{wa * a.w + wb * b.w, wa * a.x + wb * b.x, wa * a.y + wb * b.y,
                         wa * a.z + wb * b.z});
}

}  // namespace rubble::portable
