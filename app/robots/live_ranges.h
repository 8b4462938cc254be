// What LiDARs and cameras on robots measure while the robots are driven: scans, and planar depth by exact rays.
//
// A scan is cast when its last ray has left, an image at its stamp, both two steps later: a curve through the steps
// needs those after it. The ways of the sensors, and so the points on what rests, are those of the recording to the
// bit. What moves goes on a straight line between steps here, and between the samples of the track there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "kernel/base/parallel.h"
#include "kernel/world/world.h"
#include "render/lidar/depth_rays.h"
#include "render/lidar/lidar.h"
#include "render/media/medium.h"
#include "render/scene/lidar_scan.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/simulated_path.h"

namespace rubble {

// What carries a sensor: a place on a link of a robot.
struct LinkMount {
  std::size_t robot = 0, link = 0;
  Pose link_from_carrier;  // unit: m
};
// Where `carrier` is; what carries nothing of its own is on the rig. key: of the sensor. Throws InputError: the robot
// has no such link, or no robot carries the rig (`rig` is empty).
LinkMount find_link_mount(const Carrier& carrier, const std::optional<LinkMount>& rig, const std::string& key,
                          const std::vector<std::string>& names, const std::vector<MissionRobot>& robots);

struct RidingSensor {
  std::size_t number = 0;  // among the scenario's LiDARs, or all_cameras()
  LinkMount mount;
};

// Without noise, and without what the air does to depth sensors.
struct SensedDepth {
  std::int64_t stamp_ns = 0;
  std::size_t camera = 0;  // number among all_cameras()
  int width = 0, height = 0;
  std::vector<float> depth;  // row by row from the top, along the optical axis; infinite: nothing; unit: m
};

class LiveRanges {
 public:
  // scene: shows everything where it is (build_live_scene, by pose_of() of this while measuring() is true). The
  // scenario must outlive this. Throws InputError for a camera whose lens is no pinhole.
  LiveRanges(const Scenario& scenario, const std::vector<RidingSensor>& lidars,
             const std::vector<RidingSensor>& cameras, const Scene& scene, const Medium& medium, double step,
             int threads);

  bool empty() const { return scanners_.empty() && imagers_.empty(); }
  void restart(const World& world);    // at the robots' time 0
  void note_step(const World& world);  // after each step
  // All since the last call, each kind sensor by sensor in the order of stamps.
  struct Readings {
    std::vector<LidarScan> scans;
    std::vector<SensedDepth> images;
  };
  Readings take();

  // While rays are cast: where a piece or a link was, between steps on a straight line; nothing: it was not there.
  bool measuring() const { return measuring_; }
  std::optional<Pose> pose_of(int id, std::int64_t stamp_ns) const;

 private:
  // A sensor, and where its carrier was at the steps that are kept.
  struct Rider {
    RidingSensor at;
    std::vector<Pose> poses;
    std::unique_ptr<SimulatedPath> way;  // while it measures
    int next = 0;                        // scan or image
  };
  struct Scanner : Rider {
    std::unique_ptr<Lidar> lidar;
  };
  struct Imager : Rider {
    DepthRays rays;
    double rate_hz = 0;
    Pose carrier_from_camera;
    std::int64_t stamp_ns(int image, std::int64_t start_ns) const;
  };
  double since_start(std::int64_t stamp_ns) const;  // unit: s
  Pose pose_at(const Rider& rider, std::int64_t stamp_ns) const;
  std::int64_t known_until() const;
  void begin_way(Rider& rider);
  void scan(Scanner& scanner, std::vector<LidarScan>& scans);
  void look(Imager& imager, std::vector<SensedDepth>& images);
  void forget();

  const Scenario& scenario_;
  double step_;
  std::int64_t steps_ = 0, first_ = 0;
  std::vector<std::vector<std::optional<Pose>>> poses_;  // of steps from `first_` on, by id
  bool measuring_ = false;
  std::shared_ptr<LidarWorld> world_;
  std::vector<std::unique_ptr<Scanner>> scanners_;
  std::vector<std::unique_ptr<Imager>> imagers_;
  ThreadPool pool_;
};

}  // namespace rubble
