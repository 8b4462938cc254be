#include "render/media/near_glow.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/media/medium.h"

namespace rubble {

namespace {

constexpr int kDirections = 256, kSteps = 24;

// Integral over the way from x, at distance 1 from the lamp, in direction w. With the angle a at the lamp, from x on,
// d(way) / distance^2 = da / sin(angle at x).
double glow_from(const Vec3f& x, const Vec3f& w, float cone, double cosine) {
  const double along = std::clamp(double(dot(x, w)), -1.0, 1.0), sine = std::sqrt(std::max(1 - along * along, 1e-6));
  const double whole = portable::kPi - std::acos(-along);  // of the angle, as the way becomes infinite
  const Vec3f across = (w - x * float(along)) * float(1 / sine);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const portable::SinCos a = portable::sincos(whole * (i + 0.5) / kSteps);
    const Vec3f from_lamp = x * float(a.cos) + across * float(a.sin);
    const double off = double((1 - from_lamp.z) * cone);
    sum += std::exp2(-off * off) * phase_function(cosine, double(-dot(from_lamp, w)));
  }
  return sum * whole / (kSteps * sine);
}

}  // namespace

NearGlow::NearGlow(float cone, double cosine) {
  for (std::size_t k = 0; k <= kAngles; ++k) {
    const portable::SinCos angle = portable::sincos(portable::kPi * double(k) / kAngles);
    const Vec3f x(float(angle.sin), 0, float(angle.cos));
    Harmonics& out = table_.emplace_back(Harmonics{});
    for (int i = 0; i < kDirections; ++i) {
      const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * 0.6180339887498949;
      const portable::SinCos a = portable::sincos(2 * portable::kPi * (turn - std::floor(turn)));
      const double r = std::sqrt(1 - z * z);
      const Vec3f w(float(r * a.cos), float(r * a.sin), float(z));
      const float light = float(glow_from(x, w, cone, cosine) * 4 * portable::kPi / kDirections);
      const Harmonics y = harmonics_of(w);
      for (std::size_t t = 0; t < kHarmonics; ++t) out[t] += light * y[t];
    }
  }
}

std::array<float, kOrders> NearGlow::at(const AirLamp& lamp, const Vec3f& p, const Vec3f& direction, float cell) const {
  const Vec3f way = p - lamp.position;
  const float r2 = std::max(dot(way, way), lamp.size2), r = std::sqrt(r2);
  const float missing = 1 / r - 1 / std::sqrt(r2 + cell * cell);
  const float cosine = std::clamp(dot(way, lamp.axis) / r, -1.0f, 1.0f);
  const Vec3f aside = way - lamp.axis * dot(way, lamp.axis);
  const float off = norm(aside);
  Vec3f x = aside * (1 / std::max(off, 1e-6f));
  if (off < 1e-6f) x = normalized(cross(lamp.axis, std::fabs(lamp.axis.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0)));
  const Vec3f y = cross(lamp.axis, x);
  const Harmonics terms = harmonics_of({dot(direction, x), dot(direction, y), dot(direction, lamp.axis)});
  const float at = std::acos(cosine) / portable::kPiF * kAngles;
  const std::size_t low = std::min(std::size_t(at), kAngles - 1);
  const float part = at - float(low);
  std::array<float, kOrders> out{};
  for (std::size_t t = 0; t < kHarmonics; ++t)
    out[order_of(t)] += (table_[low][t] * (1 - part) + table_[low + 1][t] * part) * terms[t] * missing;
  return out;
}

}  // namespace rubble
