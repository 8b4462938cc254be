// The moment of a bent inflated cylinder (Comer and Levy 1963, "Deflections of an inflated circular-
// cylindrical cantilever beam"): linear while all of the wall is taut; from the wrinkling moment on, where
// the wall on the inner side is slack, it rises ever more slowly towards twice that moment, the collapse.
// Elastic: the same on the way back.
#pragma once

namespace rubble {

// All in units of the wrinkling moment M and of the bend at which it is reached.
struct InflatedBend {
  double moment = 0;   // 0 to 2
  double tangent = 1;  // how fast it rises
  double energy = 0;   // of the wall and of the air that is pressed out; unit: M times that bend
};

// bend: >= 0, in units of the bend at wrinkling.
InflatedBend calc_inflated_bend(double bend);

}  // namespace rubble
