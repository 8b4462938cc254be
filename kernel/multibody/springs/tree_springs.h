// Springs of the joints of a tree, also of inflated tubes.
#pragma once

#include "kernel/multibody/tree.h"

namespace rubble {

double calc_spring_energy(const Tree& tree, const std::vector<double>& q);  // unit: J

// Of a hinge of an inflated tube: the bend of its section, in units of that at which it wrinkles.
double calc_section_bend(const Tree& tree, const TreeLink& link, const std::vector<double>& q);

}  // namespace rubble
