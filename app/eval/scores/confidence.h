// How sure a mean is.
#pragma once

#include <vector>

namespace rubble {

struct MeanInterval {
  double mean = 0, low = 0, high = 0;
};

// The mean and its 95 % confidence interval by the percentile bootstrap (Efron 1979): 4,000 resamples, drawn from a
// stream of their own, so that the same values give the same interval. values: at least one; of one, the interval
// is a point.
MeanInterval calc_mean(const std::vector<double>& values);

}  // namespace rubble
