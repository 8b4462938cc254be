// What differs from photosite to photosite and stays the same in every picture, by the terms of EMVA
// Standard 1288, release 4.0: gain (PRNU), offset (DSNU), dark current, and hot pixels.
//
// Electrons of a photosite: (1 + prnu n1) times those of the light, plus dark and hot current times the
// exposure time; both have shot noise. After it, the offset dsnu n2. n1, n2 are normal, of variance 1. A
// photosite is hot with the probability hot_pixels; its current is exponential, of the mean hot_current.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scene/camera_spec.h"

namespace rubble {

class FixedPattern {
 public:
  // Of `photosites`; eye: 0: of the left or only sensor, 1: of the right one.
  FixedPattern(const ImageSensorSpec& spec, std::size_t photosites, std::uint64_t seed, int eye);

  // Electrons before shot noise. light: electrons of the light; time: unit: s
  double collect(std::size_t photosite, double light, double time) const {
    return light * double(gain_[photosite]) + time * double(current_[photosite]);
  }
  double offset(std::size_t photosite) const { return double(offset_[photosite]); }

 private:
  std::vector<float> gain_;     // about 1
  std::vector<float> offset_;   // unit: electron
  std::vector<float> current_;  // unit: electron/s
};

}  // namespace rubble
