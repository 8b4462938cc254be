// Means of the scores of a batch, with intervals that say how little few runs tell.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/batch/finished_batch.h"

namespace rubble {

// Of numbers that are taken for independent draws. Not by the bootstrap, as the scores of benchmarks (app/eval/scores): a
// batch often has two to five runs for a value of a key, for which a bootstrap interval is far too narrow.
struct StudentInterval {
  std::size_t count = 0;
  double mean = 0;       // 0 of none
  double deviation = 0;  // standard deviation, by count - 1; 0 of fewer than two
  double half = 0;       // of the 95 % interval of the mean, by Student's t; 0 of fewer than two
};
StudentInterval calc_student_interval(const std::vector<double>& values);

// The 95 % interval of a share, of which `hits` of `count` were seen (Wilson 1927). count: above 0
struct ShareInterval {
  double low = 0, high = 1;
};
ShareInterval calc_share_interval(std::size_t hits, std::size_t count);

// A table of HTML for all runs, and one for each varied key: a row for each of its values, or for five ranges with as many
// runs each where there are more than twelve numbers. metrics: numbers of columns.
std::string make_mean_tables(const FinishedBatch& batch, const std::vector<std::string>& varied,
                             const std::vector<std::size_t>& metrics);

}  // namespace rubble
