// What the robots of a drive sense while they are driven: joints, odometry, contacts, and the scans of their LiDARs.
// A scan is cast when its last ray has left, by the ways of its carrier and of all that moved meanwhile.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/robots/mission_robot.h"
#include "app/robots/robot_log.h"
#include "kernel/robot/robot_run.h"
#include "render/lidar/lidar.h"
#include "render/media/medium.h"
#include "render/scene/sample.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/simulated_path.h"

namespace rubble {

// Where a LiDAR hangs.
struct LidarMount {
  std::size_t robot = 0, link = 0;
  Pose link_from_lidar;  // unit: m
};

class LiveSensors {
 public:
  // mounts: of the scenario's LiDARs. scene: shows everything where it is (build_live_scene). The robots must outlive
  // this.
  LiveSensors(const Scenario& scenario, const std::vector<MissionRobot>& robots, std::vector<LidarMount> mounts,
              const Scene& scene, const Medium& medium, double step, int threads);

  void restart(const World& world);  // at the robots' time 0
  void note(std::size_t robot, const RobotSense& sense) { logs_[robot].note(sense); }
  void note_step(const World& world);  // after each step
  // All since the last call, in order of their stamps.
  std::vector<Sample> take();

  // While it casts rays: where a piece or a link was, between steps on a straight line; nothing: it was not there.
  bool scanning() const { return scanning_; }
  std::optional<Pose> pose_of(int id, std::int64_t stamp_ns) const;

 private:
  struct Scanner {
    LidarMount mount;
    std::unique_ptr<Lidar> lidar;
    std::unique_ptr<SimulatedPath> way;  // while it scans
    int next = 0;                        // scan
  };
  double since_first(std::int64_t stamp_ns) const;  // unit: s
  void forget();
  void scan(Scanner& scanner, int number, std::vector<Sample>& samples);

  const Scenario& scenario_;
  const std::vector<MissionRobot>& robots_;
  double step_;
  std::int64_t steps_ = 0, first_ = 0;
  std::vector<std::vector<std::optional<Pose>>> poses_;  // of steps from `first_` on, by id
  std::vector<std::vector<Pose>> ways_;                  // likewise, of LiDARs
  bool scanning_ = false;
  std::vector<RobotLog> logs_;
  std::vector<std::unique_ptr<Scanner>> scanners_;
};

}  // namespace rubble
