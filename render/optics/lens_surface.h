// Dirt and rain drops on the front of a lens, far out of focus. Where they are follows from the seed.
#pragma once

#include <cstdint>
#include <vector>

#include "render/optics/line_filters.h"

namespace rubble {

class LensSurface {
 public:
  // eye: 0: the left or only lens, 1: the right one. dirt, drops: as in OpticsSpec.
  LensSurface(int width, int height, double dirt, int drops, std::uint64_t seed, int eye);

  // Smudges take part of the light and throw half of it over the picture: image = t image + (1 - t) / 2
  // veil, t the share that passes. veil: the light of the picture spread far and wide.
  void soil(LinearImage& image, const LinearImage& veil) const;
  // A drop is a lens of a few millimetres before the lens: within its disc stands a small picture of the
  // scene upside down, out of focus and darker to its rim. soft: the picture, a little blurred.
  void wet(LinearImage& image, const LinearImage& soft) const;

 private:
  struct Spot {
    double x = 0, y = 0, radius = 0;  // unit: pixel
    double opacity = 0;               // in its middle
  };
  std::vector<Spot> smudges_, drops_;
};

}  // namespace rubble
