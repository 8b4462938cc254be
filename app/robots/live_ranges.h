// What LiDARs and cameras on robots measure while the robots are driven: scans, and planar depth by exact rays.
//
// A scan is cast when its last ray has left, an image at its stamp, both two steps later: a curve through the steps
// needs those after it. The ways of the sensors, and so the points on what rests, are those of the recording to the
// bit. What moves goes on a straight line between steps here, and between the samples of the track there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/robots/live_steps.h"
#include "kernel/base/parallel.h"
#include "render/lidar/depth_rays.h"
#include "render/lidar/lidar.h"
#include "render/media/medium.h"
#include "render/scene/lidar_scan.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Without noise, and without what the air does to depth sensors.
struct SensedDepth {
  std::int64_t stamp_ns = 0;
  std::size_t camera = 0;  // number among all_cameras()
  int width = 0, height = 0;
  std::vector<float> depth;  // row by row from the top, along the optical axis; infinite: nothing; unit: m
};

class LiveRanges {
 public:
  // scene: shows everything where it is (build_live_scene, by pose_of() of this while measuring() is true).
  // Throws InputError for a camera whose lens is no pinhole.
  LiveRanges(const Scenario& scenario, const std::vector<RidingSensor>& lidars,
             const std::vector<RidingSensor>& cameras, const Scene& scene, const Medium& medium, double step,
             int threads);

  bool empty() const { return scanners_.empty() && imagers_.empty(); }
  void restart(const World& world);  // at the robots' time 0
  void note_step(const World& world) { steps_.note_step(world); }  // after each step
  // All since the last call, each kind sensor by sensor in the order of stamps.
  struct Readings {
    std::vector<LidarScan> scans;
    std::vector<SensedDepth> images;
  };
  Readings take();

  // While rays are cast: where a piece or a link was; nothing: it was not there.
  bool measuring() const { return steps_.measuring(); }
  std::optional<Pose> pose_of(int id, std::int64_t stamp_ns) const { return steps_.pose_of(id, stamp_ns); }

 private:
  struct Scanner {
    std::size_t number = 0, carrier = 0;
    std::unique_ptr<Lidar> lidar;
    int next = 0;
  };
  struct Imager {
    std::size_t number = 0, carrier = 0;
    DepthRays rays;
    double rate_hz = 0;
    Pose carrier_from_camera;
    int next = 0;
    std::int64_t stamp_ns(int image, std::int64_t start_ns) const;
  };
  void scan(Scanner& scanner, std::vector<LidarScan>& scans);
  void look(Imager& imager, std::vector<SensedDepth>& images);
  void forget();

  LiveSteps steps_;
  std::shared_ptr<LidarWorld> world_;
  std::vector<Scanner> scanners_;
  std::vector<Imager> imagers_;
  ThreadPool pool_;
};

}  // namespace rubble
