// What a depth sensor reports, from the exact depth beside it.
//
// ideal: the depth within the range limits.
//
// structured_light (as Kinect v1): disparity d = f b / Z of a camera f pixels wide, here of an image
//   640 wide, is measured with normal noise and rounded to disparity_step. Standard deviation and
//   resolution of depth then grow with Z^2: sigma_Z = Z^2 sigma_d / (f b) (Khoshelham and Elberink
//   2012, eq. 10; their Kinect's 1.425e-5 /cm is the default 1/16 pixel of f b = 586 pixel * 75 mm).
//   On faces seen at the angle a from their normal, noise grows as Nguyen, Izadi and Lovell 2012
//   found: plus 1e-4 m^1.5 / sqrt(Z) * a^2 / (pi/2 - a)^2. No return: beyond the range; in the
//   shadow of the projector, which stands `baseline` to the right (found by casting rays); at more
//   than 80 degrees; with twice the probability of the share of the correlation window (9 x 9 pixels
//   of 640) that lies on another surface.
//
// time_of_flight: each pixel is the sum of returns A exp(i 4 pi f r / c) over its footprint (the
//   weights 1 2 1 over neighbours, so that an edge gives pixels that fly between two surfaces), with
//   A = signal * reflectance * cos a / r^2, in electrons. Range noise is (L / sqrt 8) sqrt(A + B) /
//   (2 A), L = c / 2f, B the background (Lange and Seitz 2001, eq. 13); ranges wrap at L; a return
//   below least_amplitude is none. Unless the specification states one reflectance for all surfaces,
//   it is that of each surface's look for red light: the infrared of such sensors is next to it.
//
// Air of extinction s(r), albedo w and phase function p, the same Medium as the colour image looks
// through: light to a surface and back keeps the share T^2 = exp(-2 tau), and the air throws back
//   w s(r) p(cos b) * exp(-2 tau(r)) / e^2 dr,  against  reflectance / pi * cos a / Z^2 * T^2
// of the surface, where e is the distance from the emitter beside the lens, which lights what the
// camera sees (a cone as wide as the image, so that the air just before the lens is dark), and b the
// angle between the light's way out and its way back: near 180 degrees far away, less near by. A time-of-flight sensor adds both, so that dense air pulls ranges towards itself.
// To structured light what the air throws back is a veil of the ratio q to the surface's light: noise
// grows as 1 + q, the pattern is lost with the probability q / (1 + q) less a third, times 1.5, and a
// lost pixel reports the air instead (an early return) where the air is as compact as a surface: the
// middle half of its light comes from a tenth of its range.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/media/medium.h"
#include "render/scene/camera_spec.h"

namespace rubble {

// The exact view that is measured. Rows from the top.
struct DepthView {
  const ViewRays& rays;                        // through which it was drawn
  const std::vector<float>& distances;         // along the ray; NaN: none
  const std::vector<float>& normals;           // of the stream `normals`
  const std::vector<std::uint8_t>& projected;  // 1: the projector sees it; only structured light
  // Of the surfaces, 0 to 1, in the sensor's light: for a specification that states none.
  const std::vector<float>& albedos;
  const Air& air;  // at its stamp
  int frame = 0;   // number of the frame, for the noise
};

class DepthSensor {
 public:
  explicit DepthSensor(const CameraSpec& spec) : spec_(spec) {}

  // Planar depth; NaN: no return.
  std::vector<float> measure(const DepthView& view) const;
  // Where the projector of structured light is, in the camera body frame.
  Vec3 projector() const { return {0, -spec_.depth_sensor.baseline, 0}; }

 private:
  struct Returns;
  struct Phasor {
    double real = 0, imaginary = 0;
  };

  Returns trace_air(const DepthView& view, int u, int v, double distance) const;
  double emitter_offset() const;  // of whatever sends the light, to the lens's right; unit: m
  double lit_from(const DepthView& view, const Vec3& direction) const;  // along the ray; unit: m
  double reflectance_at(const DepthView& view, int u, int v) const;
  float measure_ideal(const DepthView& view, int u, int v) const;
  float measure_disparity(const DepthView& view, int u, int v) const;
  float measure_phase(const DepthView& view, const std::vector<Phasor>& phasors, int u,
                      int v) const;
  Phasor surface_phasor(const DepthView& view, int u, int v) const;
  double other_surface_share(const DepthView& view, int u, int v) const;

  CameraSpec spec_;
};

}  // namespace rubble
