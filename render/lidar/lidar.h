// A LiDAR on its carrier: scans of a world, each ray cast from where the sensor is at the ray's own time.
//
//   ScanPattern -> ray -> pose at its time -> Beam -> echoes -> ScanPoint, in the sensor's frame then
//
// The pose is that of the carrier at every 50 us, and on straight lines between: at 10 m/s2 within 4
// nanometres. What moves in the scene, and dust, are followed in steps of 5 ms, between which what moves
// goes on a straight line. A scan depends on its number, not on the scans before nor on the threads.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kernel/base/parallel.h"
#include "render/lidar/beam.h"
#include "render/lidar/scan_pattern.h"
#include "render/scene/range_scan.h"

namespace rubble {

struct LidarPlace {
  std::function<Pose(std::int64_t stamp_ns)> world_from_sensor;  // at any time
  std::int64_t start_ns = 0;                                    // the stamp of its first scan
};

class Lidar {
 public:
  // A scan asks where things are up to that time after its last ray; unit: ns
  static constexpr std::int64_t kSceneStep = 5'000'000;

  // medium: what the scene's air is, with its time zero at start_ns. seed: of all noise.
  Lidar(const LidarSpec& spec, std::shared_ptr<RayWorld> world, LidarPlace place, const Medium& medium,
        std::uint64_t seed, int threads);

  const LidarSpec& spec() const { return *spec_; }
  std::int64_t stamp_ns(int scan) const { return place_.start_ns + pattern_.begin_ns(scan); }
  RangeScan take(int scan);

 private:
  struct Slice;
  std::vector<Pose> poses_of(std::int64_t stamp_ns, std::int64_t duration_ns);
  void measure(const Slice& slice, std::size_t begin, std::size_t end, std::vector<ScanPoint>& found,
               std::vector<std::uint8_t>& counts) const;

  std::shared_ptr<const LidarSpec> spec_;
  std::shared_ptr<RayWorld> world_;
  LidarPlace place_;
  Medium medium_;
  std::uint64_t seed_;
  ScanPattern pattern_;
  ThreadPool pool_;
};

}  // namespace rubble
