#include "kernel/multibody/springs/inflated_bend.h"

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr int kBisections = 50;  // halvings of the arc of taut wall: to its last bits; unit: 1

// Half the arc of taut wall, e in (0, pi]: the wall's tension balances the pressure where
// sin e - e cos e = pi / bend, which rises with e.
double find_taut_arc(double bend) {
  double low = 0, high = portable::kPi;
  for (int i = 0; i < kBisections; ++i) {
    const double e = 0.5 * (low + high);
    const auto [s, c] = portable::sincos(e);
    (s - e * c < portable::kPi / bend ? low : high) = e;
  }
  return 0.5 * (low + high);
}

}  // namespace

InflatedBend calc_inflated_bend(double bend) {
  if (bend <= 1) return {bend, 1, 0.5 * bend * bend};
  const double e = find_taut_arc(bend);
  const auto [s, c] = portable::sincos(e);
  InflatedBend result;
  result.moment = (e - s * c) / (s - e * c);
  result.tangent = (e + s * c - 2 * s * s / e) / portable::kPi;
  const double squares = e * (c * c + 0.5) - 1.5 * s * c;  // integral of the squared strains
  result.energy = 1 + bend * bend * squares / portable::kPi + 2 * bend * c;
  return result;
}

}  // namespace rubble
