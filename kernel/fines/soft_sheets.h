// Sheets of paper, whole and torn, with corners that curl; and cloth that drapes over what it fell on.
#pragma once

#include "kernel/fines/grains.h"

namespace rubble {

// kind: paper or cloth. As many as asked for, or as many as there is room for.
void drop_sheets(const GrainGround& ground, FineKind kind, int count, RoomForFines& room,
                 std::vector<FineSheet>& sheets);

}  // namespace rubble
