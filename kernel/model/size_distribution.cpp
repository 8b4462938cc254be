#include "kernel/model/size_distribution.h"

#include "kernel/base/portable_math.h"

namespace rubble {

double draw_size(const SizeDistribution& spread, double min, double max, RandomStream& random) {
  for (int tries = 0; spread.kind != Spread::uniform && tries < 1000; ++tries) {
    const double x = spread.deviation * random.normal();
    const double size = spread.kind == Spread::normal ? spread.typical + x
                                                      : spread.typical * portable::exp(x);
    if (size >= min && size <= max) return size;
  }
  return random.uniform(min, max);
}

}  // namespace rubble
