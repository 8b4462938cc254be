// Distribution of the sizes of pieces.
#pragma once

#include "kernel/base/random.h"

namespace rubble {

enum class Spread { uniform, normal, lognormal };

struct SizeDistribution {
  Spread kind = Spread::uniform;  // uniform ignores the members below
  double typical = 1;      // mean of the normal, median of the lognormal; range: above 0, to 100
  double deviation = 0.2;  // standard deviation of the size, or of its natural logarithm;
                           // range: above 0, to 10
};

// Draws a size in [min, max]. A draw outside is repeated, so the distribution is truncated and does not pile up at
// the limits. After 1000 draws outside (a range far in a tail) the size is uniform. The normal distribution is that
// of RandomStream, whose tails end at 6 deviations.
double draw_size(const SizeDistribution& spread, double min, double max, RandomStream& random);

}  // namespace rubble
