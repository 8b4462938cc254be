// Options of a world, and the pieces that are added to it.
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
  bool sleeping = true;        // whether motionless pieces fall asleep
};

struct NewPiece {
  Placement placement;
  Vec3 linear_velocity;   // of the centre of mass, or of that of an assembly's root; unit: m/s
  Vec3 angular_velocity;  // an assembly moves as one rigid body; unit: rad/s
  int layer = 0;
};

// One part of a rigid group that comes apart. Its pieces form one body.
struct SplitPart {
  std::vector<int> pieces;  // ascending, not empty
  bool fixed = false;       // immovable; only if the whole group was
};

}  // namespace rubble
