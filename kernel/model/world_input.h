// How a world is made, and what is put into it.
#pragma once

#include <vector>

#include "kernel/model/pile.h"

namespace rubble {

struct WorldOptions {
  double gravity = 9.81;       // unit: m/s2, downwards
  double step = 1.0 / 60.0;    // unit: s; range: 1/1000 to 1/30
  double lost_below = -0.5;    // unit: m
  double lost_beyond = 100.0;  // from the Z axis; unit: m
  int threads = 0;             // 0: all processors; the result does not depend on it
  bool sleeping = true;        // pieces that stay in place are put to sleep
};

struct NewPiece {
  Placement placement;
  Vec3 linear_velocity;   // of the centre of mass; of an assembly that of its root; unit: m/s
  Vec3 angular_velocity;  // of an assembly as one rigid body; unit: rad/s
  int layer = 0;
};

// Some of the pieces of a rigid group that comes apart; together they go on as one body.
struct SplitPart {
  std::vector<int> pieces;  // ascending, not empty
  bool fixed = false;       // goes on immovable; only where the whole was
};

}  // namespace rubble
