// Springs of the joints of a tree, also of inflated tubes.
#pragma once

#include "kernel/multibody/tree.h"

namespace rubble {

// The moment of a bent inflated cylinder (Comer and Levy 1963, "Deflections of an inflated circular-
// cylindrical cantilever beam"): linear while all of the wall is taut; from the wrinkling moment on, where
// the wall on the inner side is slack, it rises ever more slowly towards twice that moment, the collapse.
// Elastic: the same on the way back.

// All in units of the wrinkling moment M and of the bend at which it is reached.
struct InflatedBend {
  double moment = 0;   // 0 to 2
  double tangent = 1;  // how fast it rises
  double energy = 0;   // of the wall and of the air that is pressed out; unit: M times that bend
};

// bend: >= 0, in units of the bend at wrinkling.
InflatedBend calc_inflated_bend(double bend);

double calc_spring_energy(const Tree& tree, const std::vector<double>& q);  // unit: J

// Of a hinge of an inflated tube: the bend of its section, in units of that at which it wrinkles.
double calc_section_bend(const Tree& tree, const TreeLink& link, const std::vector<double>& q);

}  // namespace rubble
