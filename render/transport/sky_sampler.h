// Directions towards the sky, drawn in proportion to how bright it is there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/lighting/lighting.h"
#include "render/transport/sample_sequence.h"

namespace rubble {

class SkySampler {
 public:
  explicit SkySampler(const Sky& sky);

  struct Sample {
    Vec3f direction;    // unit length, pointing up
    float density = 0;  // unit: 1/sr; 0: the sky is black
  };
  Sample draw(SamplePair u) const;
  float density(const Vec3f& direction) const;  // unit: 1/sr

 private:
  // A running sum over the intervals of one line, and for each of as many equal parts of [0, 1) the interval
  // in which it begins, so that a search takes a step or two.
  struct Line {
    std::vector<float> sums;
    std::vector<std::uint16_t> start;

    void accumulate(const std::vector<float>& weights);
    int find(float u, float& within) const;
    float share(int i) const { return sums[std::size_t(i) + 1] - sums[std::size_t(i)]; }
  };
  int side_;  // of the sky's map
  bool black_ = true;
  Line rows_;
  std::vector<Line> columns_;  // of each row
};

}  // namespace rubble
