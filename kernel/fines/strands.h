// Cables and pipes that hang as catenaries between pieces.
#pragma once

#include "kernel/fines/grains.h"

namespace rubble {

// kind: cable or pipe. As many as asked for, or as many as there is room for: no part of one is in a piece but for
// its ends, which reach a little way into what holds them.
void hang_strands(const GrainGround& ground, FineKind kind, int count, std::vector<FineSheet>& sheets);

}  // namespace rubble
