// Cables and pipes that hang as catenaries between pieces.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "kernel/fines/grains.h"

namespace rubble {

// The curve of a chain that hangs between two points: y = a cosh((x - x0) / a) + c.
struct Catenary {
  Vec3 from;       // one end; unit: m
  Vec3 along;      // level unit vector from there to below or above the other end
  double span = 0;  // level distance between the ends; unit: m
  double a = 1;     // horizontal tension over weight per length; unit: m
  double x0 = 0;    // where it is lowest, along the span; unit: m
  double c = 0;     // of the height above `from`; unit: m

  Vec3 at(double x) const;  // x: from 0 to span; unit: m
};

// Throws std::invalid_argument where the ends are upright above each other or the length is not above their
// distance. unit: m.
Catenary hang(const Vec3& from, const Vec3& to, double length);

double cosh_of(double x);  // of the same bits on every machine; range: |x| <= 700
double sinh_of(double x);  // likewise

// kind: cable or pipe. As many as asked for, or as many as there is room for: no part of one is in a piece but for
// its ends, which reach a little way into what holds them.
void hang_strands(const GrainGround& ground, FineKind kind, int count, std::vector<FineSheet>& sheets);

}  // namespace rubble
