// Whether a structure stands by itself.
#pragma once

#include <vector>

#include "kernel/structure/stress.h"

namespace rubble {

// The forces in a structure's bonds under its own weight, by bond. Throws InputError naming the worst
// bond, its failure and by how much, where one is used up: the building does not stand by itself.
std::vector<SectionForces> check_stands(const Structure& structure, double gravity);

}  // namespace rubble
