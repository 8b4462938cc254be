#include "app/eval/scores/confidence.h"

#include <algorithm>
#include <numeric>

#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr std::size_t kResamples = 4000;

}  // namespace

MeanInterval calc_mean(const std::vector<double>& values) {
  const double count = double(values.size());
  MeanInterval result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  RandomStream random(0, "search/confidence");
  std::vector<double> means(kResamples);
  for (double& mean : means) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[random.below(values.size())];
    mean = sum / count;
  }
  std::sort(means.begin(), means.end());
  result.low = means[kResamples * 25 / 1000], result.high = means[kResamples * 975 / 1000];
  return result;
}

}  // namespace rubble
