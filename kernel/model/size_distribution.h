// How the sizes of pieces are spread over their range.
#pragma once

#include "kernel/base/random.h"

namespace rubble {

enum class Spread { uniform, normal, lognormal };

struct SizeDistribution {
  Spread kind = Spread::uniform;  // which of the members below count
  double typical = 1;      // mean of the normal, median of the lognormal; range: above 0, to 100
  double deviation = 0.2;  // standard deviation of the size, or of its natural logarithm;
                           // range: above 0, to 10
};

// A size in [min, max]: what falls outside is drawn again, so that the distribution is cut off there
// and not heaped up. After 1000 draws outside (a range far off in a tail) it is uniform.
// The normal is that of RandomStream, whose tails end at 6 deviations.
double draw_size(const SizeDistribution& spread, double min, double max, RandomStream& random);

}  // namespace rubble
