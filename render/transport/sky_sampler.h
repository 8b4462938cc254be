// Directions towards the sky, drawn in proportion to how bright it is there.
#pragma once

#include <array>
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
  // A running sum over the intervals of one line, and for each kSide-th part of [0, 1) the interval
  // in which it begins, so that a search takes a step or two.
  struct Line {
    std::array<float, Sky::kSide + 1> sums{};
    std::array<std::uint8_t, Sky::kSide> start{};

    void accumulate(const std::array<float, Sky::kSide>& weights);
    int find(float u, float& within) const;
    float share(int i) const { return sums[std::size_t(i) + 1] - sums[std::size_t(i)]; }
  };
  bool black_ = true;
  Line rows_;
  std::vector<Line> columns_;  // of each row
};

}  // namespace rubble
