// What comes back of one beam of a LiDAR: echoes of surfaces and of what hangs in the air.
//
// A beam is not a line. Its light falls off as a Gaussian about its axis; eight rays of equal weight, one
// along the axis and seven around it at sqrt(16/7) standard deviations, have its second moment. Each that
// meets a surface gives back the share
//   e = 1/8 * reflectance * cos(a) * T^2 / r^2,   T = exp(-optical depth),
// for a matt surface that fills the receiver's view (Lambert; e.g. Wagner 2010, "Radiometric calibration
// of small-footprint full-waveform airborne laser scanner measurements"). Echoes nearer together than
// echo_separation are one, at the mean range weighted by e: at an edge a point flies between two
// surfaces. Farther apart they are two.
//
// The air gives back pi * scattering(p, straight back) * T^2 / r^2 dr, the same Medium as the camera looks
// through, from where transmitter and receiver overlap: not at all below 0.9 m, fully above 1 m (Hahner
// et al. 2021, "Fog simulation on real LiDAR point clouds for 3D object detection in adverse weather").
// Smoke and dust are grains: the echo's range is drawn with the density of what comes back, and what
// comes from within half an echo_separation of it is its strength.
//
// An echo is reported when its strength, of which noise takes or adds 10 % (standard deviation; our
// choice), is at least that of a facing surface of 10 % at range_at_10_percent in clear air. Its
// intensity is 100 * reflectance * cos(a) * T^2, corrected for range: a facing white surface in clear
// air has 100.
#pragma once

#include <array>

#include "render/media/medium.h"
#include "render/rays/ray_world.h"
#include "render/scene/lidar_spec.h"
#include "render/sensors/noise_field.h"

namespace rubble {

struct Echo {
  double range = 0;      // unit: m
  double strength = 0;   // 1: just enough to be seen
  double intensity = 0;  // see above
};

// At most two, as LidarSpec::returns says.
struct Echoes {
  std::array<Echo, 2> list;
  int count = 0;
};

class Beam {
 public:
  // The world must outlive it.
  Beam(const LidarSpec& spec, const RayWorld& world) : spec_(spec), world_(world) {}

  // noise: of this scan; ray: its number in the scan.
  Echoes measure(const RayWorld::Ray& axis, const Air& air, const NoiseField& noise,
                 std::uint64_t ray) const;

 private:
  struct Parts;
  void add_surfaces(const RayWorld::Ray& axis, const Air& air, Parts& parts) const;
  void add_air(const RayWorld::Ray& axis, const Air& air, double random, Parts& parts) const;
  // Those that are strong enough and within reach, the nearest first.
  int merge(Parts& parts, const NoiseField& noise, std::uint64_t ray, std::array<Echo, 9>& found) const;
  Echoes choose(const std::array<Echo, 9>& found, int count) const;
  double round_range(double range, double normal) const;

  const LidarSpec& spec_;
  const RayWorld& world_;
};

}  // namespace rubble
