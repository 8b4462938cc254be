// Low mounds of dust and the finest debris: at the foot of walls and in corners, and a few on open floors.
#pragma once

#include "kernel/fines/grains.h"

namespace rubble {

// As many as asked for, or as many as there is room for.
void heap_drifts(const GrainGround& ground, int count, std::vector<FineSheet>& sheets);

}  // namespace rubble
