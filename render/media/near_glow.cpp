#include "render/media/near_glow.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/media/medium.h"

namespace rubble {

namespace {

constexpr int kDirections = 256, kSteps = 24;

// Integral over the way from x, at distance 1 from the lamp, in direction w. With the angle a at the lamp, from x on,
// d(way) / distance^2 = da / sin(angle at x).
double glow_from(const Vec3f& x, const Vec3f& w, float cone, double cosine) {
  const double along = std::clamp(double(dot(x, w)), -1.0, 1.0), sine = std::sqrt(std::max(1 - along * along, 1e-6));
  const double whole = portable::kPi - quick::acos(-along);  // of the angle, as the way becomes infinite
  const Vec3f across = (w - x * float(along)) * float(1 / sine);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const portable::SinCos a = portable::sincos(whole * (i + 0.5) / kSteps);
    const Vec3f from_lamp = x * float(a.cos) + across * float(a.sin);
    const double off = double((1 - from_lamp.z) * cone);
    sum += quick::exp2(-off * off) * phase_function(cosine, double(-dot(from_lamp, w)));
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

}  // namespace rubble
