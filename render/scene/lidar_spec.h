// A LiDAR as plain data: where its rays go and when, what it can tell apart, and how it errs. The
// figures of real ones: scripting/sensors/lidar_models.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble {

enum class LidarPattern {
  spinning,  // every ring at each of `columns` azimuths
  rosette,   // never the same twice: see ScanPattern
  planar,    // one ring, over an angle
};

// Which echoes of a ray are reported, of those that are strong enough.
enum class LidarReturns { strongest, last, dual };  // dual: the strongest, and the last or next strongest

struct LidarSpec {
  std::string model = "VLP-16";                        // for readers of recordings
  LidarPattern pattern = LidarPattern::spinning;       // where its rays go
  std::vector<double> elevations_deg;                  // of each ring, rising; unit: degree
  std::vector<double> azimuths_deg{};                  // of each ring beside its column, from X towards Y; empty: 0
  double beam_radius = 0, beam_height = 0;             // of the point that rays leave: from the axis of rotation, towards
                                                       // the column; above the origin; unit: m
  std::vector<std::int64_t> delays_ns;                 // of each ring after its column begins
  int columns = 1;                                     // firings of each ring in a scan; above 0
  std::int64_t column_ns = 0;                          // from one firing to the next; above 0
  double rate_hz = 10;                                 // scans per second
  double first_azimuth_deg = 180;                      // of column 0, from X towards Y
  double span_deg = -360;                              // from column 0 to column `columns`; negative:
                                                       // clockwise seen from above
  double min_range = 0.5, max_range = 100;             // nothing else is reported; unit: m
  double range_at_10_percent = 35;                     // to which a facing surface of 10 % is seen; unit: m
  double range_noise = 0.015;                          // standard deviation; unit: m; range: 0 to 1
  double range_step = 0.002;                           // resolution; 0: not rounded; unit: m
  double divergence_mrad = 2.25;                       // full angle at 1/e^2 of the middle; 0: a line
  double echo_separation = 1;                          // nearer echoes of one ray are one; unit: m; above 0
  LidarReturns returns = LidarReturns::strongest;      // what is reported
  bool noise = true;                                   // false: neither range noise nor chance in detection

  int rings() const { return int(elevations_deg.size()); }
  int rays() const { return rings() * columns; }       // of a scan
  bool planar() const { return pattern == LidarPattern::planar; }
  // Whether the number of its column and ring alone tells where a ray goes, rings at even distances.
  bool regular = true;
};

}  // namespace rubble
