// From the light of a perfect lens to that of a real one, in the order in which light meets the causes:
//
//   dirt and drops on its front -> defocus -> lateral chromatic aberration -> point spread -> glare
//
// Point spread function: (1 - g) times a Gaussian plus g times the skirt, g the share that is scattered.
// The skirt is the mean of seven Gaussians whose standard deviations double from 1/256 to 1/4 of the
// picture's width. Each octave of distance gets the same light, which falls as 1 / r^2: the scatter of
// polished surfaces, whose ABg model has the slope g of about 2 (Harvey 1976, "Light-Scattering
// Characteristics of Optical Surfaces"; Pfisterer 2011, "Approximated Scatter Models for Stray Light
// Analysis"). All parts keep the sum of the light to 1e-6.
//
// Lateral chromatic aberration: red is magnified by 1 + m / 2 about the principal point, blue by 1 - m / 2,
// m = lateral_colour over the distance of the farthest corner.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/optics/defocus.h"
#include "render/optics/line_filters.h"
#include "render/scene/frame.h"
#include "render/scene/optics_spec.h"

namespace rubble {

class LensSurface;

class LensOptics {
 public:
  // f_number: of the aperture; seed: of dirt and drops. The result does not depend on `threads`.
  LensOptics(const OpticsSpec& spec, double f_number, const Intrinsics& intrinsics, std::uint64_t seed,
             int threads);
  ~LensOptics();

  // Defocus, of one sharp image: of a fisheye `depth` is the distance along the rays. Nothing to do where
  // all distances are sharp.
  bool defocuses() const { return spec_.focus_distance > 0; }
  std::vector<float> defocus(std::vector<float> rgb, const std::vector<float>& depth) const;
  // All else, of the mean light over the exposure. eye: 0: left or only one, 1: right.
  std::vector<float> spread(std::vector<float> rgb, int eye) const;

 private:
  LinearImage shift_colours(const LinearImage& image) const;

  OpticsSpec spec_;
  Intrinsics intrinsics_;
  ThinLens lens_;
  std::unique_ptr<LensSurface> surfaces_[2];  // of each eye
  int threads_;
};

// The skirt of the point spread function: all light of the picture spread wide.
LinearImage spread_glare(const LinearImage& image, int threads);

}  // namespace rubble
