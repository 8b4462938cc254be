// Where the rays of a scan go, and when.
//
// spinning, planar: column c of ring r leaves c * column_ns + delays_ns[r] after the scan begins, at the
//   azimuth first_azimuth + span * c / columns + azimuths_deg[r] and the ring's elevation. It leaves from a circle about
//   the axis, at the column's azimuth, or from the origin.
// rosette: a prism turns the beam round and another nods it, at rates whose ratio is no fraction, so
//   that the lines of one scan fall between those of the scans before and the view fills with time:
//     azimuth = 2 pi (f_a t + ring / rings),   elevation = middle + half * sin(2 pi (f_e t + ring / rings))
//   between the lowest and the highest of elevations_deg, with f_a = 7.6393 and f_e = 164.721 1/s (our
//   choice: the makers of such sensors do not publish theirs). t runs on from scan to scan.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/lidar_spec.h"

namespace rubble {

struct PatternRay {
  Vec3 direction;              // in the frame of the sensor, unit length
  Vec3 origin;                 // likewise; unit: m
  std::int64_t offset_ns = 0;  // since the scan began
  std::uint16_t ring = 0, column = 0;
};

class ScanPattern {
 public:
  explicit ScanPattern(const LidarSpec& spec);
  // The rays of that scan, in the order in which they leave.
  const std::vector<PatternRay>& rays(int scan);
  // When that scan begins, since the first one did; unit: ns
  std::int64_t begin_ns(int scan) const;

 private:
  void turn_rosette(int scan);

  LidarSpec spec_;
  std::vector<PatternRay> rays_;
  int scan_ = -1;  // that rays_ are of; a pattern that repeats: any
};

}  // namespace rubble
