// Directions towards the sky, drawn in proportion to how bright it is there.
#pragma once

#include <vector>

#include "render/lighting/lighting.h"
#include "render/reference/sample_sequence.h"

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
  std::vector<float> rows_;     // cumulative, kSide + 1
  std::vector<float> columns_;  // of each row, kSide + 1
};

}  // namespace rubble
