// Transcendental functions with the same bits on every machine, quick enough for pixels and rays.
//
// As portable_math.h they use only +, -, *, / and sqrt. That one is older and slower: its divisions stay, because the
// hashes of piles depend on its last bits. These are polynomials: within 1e-15 of the value's size, or 1e-15 absolutely
// for sin, cos, atan2 and erf, against libm (tests/base). Those of float compute in double, and round.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace rubble::quick {

inline constexpr double kLn2 = 0.69314718055994530942, kLog2E = 1.4426950408889634074;

namespace detail {

// range: |x| < 2^31
inline int round(double x) { return int(x < 0 ? x - 0.5 : x + 0.5); }
// e: from -1022 to 1023
inline double power_of_two(int e) {
  const std::uint64_t bits = std::uint64_t(1023 + e) << 52;
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
// Series of a double, or of several in the lanes of a register (render/sensors/wide_noise.cpp), whose code must not end up in
// that of another instruction set.
#define RUBBLE_SERIES template <typename Real> [[gnu::always_inline]] inline Real

// (e^r - 1) / r for |r| <= 0.35: Taylor's.
RUBBLE_SERIES exp_series(Real r) {
  Real p = Real() + 1.1470745597729725e-11;  // 1/14!
  p = p * r + 1.6059043836821613e-10;
  p = p * r + 2.08767569878681e-09;
  p = p * r + 2.505210838544172e-08;
  p = p * r + 2.755731922398589e-07;
  p = p * r + 2.7557319223985893e-06;
  p = p * r + 2.48015873015873e-05;
  p = p * r + 1.9841269841269841e-04;
  p = p * r + 1.3888888888888889e-03;
  p = p * r + 8.333333333333333e-03;
  p = p * r + 4.1666666666666664e-02;
  p = p * r + 1.6666666666666666e-01;
  p = p * r + 0.5;
  return p * r + 1.0;
}
// log(m) for f = (m - 1) / (m + 1), m from sqrt(1/2) to sqrt(2).
RUBBLE_SERIES log_series(Real f) {
  const Real s = f * f;
  Real p = Real() + 1.0 / 21;
  p = p * s + 1.0 / 19;
  p = p * s + 1.0 / 17;
  p = p * s + 1.0 / 15;
  p = p * s + 1.0 / 13;
  p = p * s + 1.0 / 11;
  p = p * s + 1.0 / 9;
  p = p * s + 1.0 / 7;
  p = p * s + 1.0 / 5;
  p = p * s + 1.0 / 3;
  return 2.0 * (f + f * s * p);
}
// For |r| <= pi / 4.
RUBBLE_SERIES sin_series(Real r) {
  const Real s = r * r;
  Real a = Real() - 7.647163731819816e-13;  // -1/15!
  a = a * s + 1.6059043836821613e-10;
  a = a * s - 2.505210838544172e-08;
  a = a * s + 2.7557319223985893e-06;
  a = a * s - 1.9841269841269841e-04;
  a = a * s + 8.333333333333333e-03;
  a = a * s - 1.6666666666666666e-01;
  return r + r * s * a;
}
RUBBLE_SERIES cos_series(Real r) {
  const Real s = r * r;
  Real b = Real() + 4.779477332387385e-14;  // 1/16!
  b = b * s - 1.1470745597729725e-11;
  b = b * s + 2.08767569878681e-09;
  b = b * s - 2.755731922398589e-07;
  b = b * s + 2.48015873015873e-05;
  b = b * s - 1.3888888888888889e-03;
  b = b * s + 4.1666666666666664e-02;
  b = b * s - 0.5;
  return 1.0 + s * b;
}
#undef RUBBLE_SERIES

// log(m) and the e of x = 2^e m, m from sqrt(1/2) to sqrt(2). x: normal, above 0.
inline double log_of_fraction(double x, int& e) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint64_t moved = bits - 0x3fe6a09e667f3bcdull;
  e = int(std::int64_t(moved) >> 52);
  bits = (moved & 0x000fffffffffffffull) + 0x3fe6a09e667f3bcdull;
  double m;
  std::memcpy(&m, &bits, sizeof m);
  return log_series((m - 1.0) / (m + 1.0));
}
// On [0, 1]: two halvings of the angle, then the series.
inline double atan_unit(double x) {
  x = x / (1.0 + std::sqrt(1.0 + x * x));
  x = x / (1.0 + std::sqrt(1.0 + x * x));
  const double s = x * x;
  double p = 1.0 / 21;
  p = 1.0 / 19 - s * p;
  p = 1.0 / 17 - s * p;
  p = 1.0 / 15 - s * p;
  p = 1.0 / 13 - s * p;
  p = 1.0 / 11 - s * p;
  p = 1.0 / 9 - s * p;
  p = 1.0 / 7 - s * p;
  p = 1.0 / 5 - s * p;
  p = 1.0 / 3 - s * p;
  return 4.0 * (x - x * s * p);
}

}  // namespace detail

// 0 below -708, infinite above 709.
inline double exp(double x) {
  if (!(x > -708.0 && x < 709.0)) return x != x ? x : x < 0 ? 0.0 : std::numeric_limits<double>::infinity();
  const int k = detail::round(x * kLog2E);
  const double r = (x - k * 0x1.62e42fefp-1) - k * 0x1.473de6af278edp-34;
  return (1.0 + r * detail::exp_series(r)) * detail::power_of_two(k);
}
// 0 below -1022, infinite above 1023. Whole powers are exact.
inline double exp2(double x) {
  if (!(x > -1022.0 && x < 1023.0)) return x != x ? x : x < 0 ? 0.0 : std::numeric_limits<double>::infinity();
  const int k = detail::round(x);
  const double r = (x - k) * kLn2;
  return (1.0 + r * detail::exp_series(r)) * detail::power_of_two(k);
}
inline double expm1(double x) { return x > -0.34 && x < 0.34 ? x * detail::exp_series(x) : exp(x) - 1.0; }
// Of what is below 2.3e-308: minus infinity.
inline double log(double x) {
  if (!(x >= std::numeric_limits<double>::min())) return -std::numeric_limits<double>::infinity();
  int e;
  const double m = detail::log_of_fraction(x, e);
  return e * 0x1.62e42fefp-1 + (e * 0x1.473de6af278edp-34 + m);
}
// Of whole powers exact.
inline double log2(double x) {
  if (!(x >= std::numeric_limits<double>::min())) return -std::numeric_limits<double>::infinity();
  int e;
  const double m = detail::log_of_fraction(x, e);
  return e + m * kLog2E;
}
inline double log10(double x) { return log(x) * 0.43429448190325182765; }
// range: above -1
inline double log1p(double x) {
  const double u = 1.0 + x;
  return u == 1.0 ? x : log(u) * (x / (u - 1.0));
}
// Of a positive x; of others 0. The error grows with |y log(x)|.
inline double pow(double x, double y) { return x > 0 ? exp2(y * log2(x)) : 0.0; }
inline double cbrt(double x) { return x < 0 ? -pow(-x, 1.0 / 3) : pow(x, 1.0 / 3); }

struct SinCos {
  double sin, cos;
};
// unit: rad; range: |x| <= 1e6
inline SinCos sincos(double x) {
  const int k = detail::round(x * 0.63661977236758134308);
  const double r = ((x - k * 0x1.921fb544p+0) - k * 0x1.0b4611a6p-34) - k * 0x1.3198a2e037073p-69;
  const double sine = detail::sin_series(r), cosine = detail::cos_series(r);
  switch (k & 3) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
  }
}
inline double sin(double x) { return sincos(x).sin; }
inline double cos(double x) { return sincos(x).cos; }
inline double tan(double x) {
  const SinCos s = sincos(x);
  return s.sin / s.cos;
}
// In (-pi, pi]; atan2(0, 0) = 0.
inline double atan2(double y, double x) {
  constexpr double kPi = 3.14159265358979323846;
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax == 0.0 && ay == 0.0) return 0.0;
  double angle = ay <= ax ? detail::atan_unit(ay / ax) : kPi / 2 - detail::atan_unit(ax / ay);
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}
// range: |x| <= 1
inline double acos(double x) { return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }
inline double hypot(double x, double y) { return std::sqrt(x * x + y * y); }
double erf(double x);

inline float exp(float x) { return float(exp(double(x))); }
inline float exp2(float x) { return float(exp2(double(x))); }
inline float log2(float x) { return float(log2(double(x))); }
inline float log10(float x) { return float(log10(double(x))); }
inline float pow(float x, float y) { return float(pow(double(x), double(y))); }
inline float sin(float x) { return float(sin(double(x))); }
inline float cos(float x) { return float(cos(double(x))); }
inline float tan(float x) { return float(tan(double(x))); }
inline float atan2(float y, float x) { return float(atan2(double(y), double(x))); }
inline float hypot(float x, float y) { return float(hypot(double(x), double(y))); }

}  // namespace rubble::quick
