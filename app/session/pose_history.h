// Where things were while robots are driven: what carries sensors at every step, and each piece and link at any time.
//
// One history for all that asks: sensors that are measured meanwhile, and those that record afterwards. Both get the same
// poses, bit for bit: a curve through the steps of a carrier, which is final up to two steps ago, and the track, which is
// final up to its last sample.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "app/sensors/robot_readings.h"
#include "io/recording/recording.h"
#include "kernel/robot/robot_run.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/simulated_path.h"

namespace rubble {

class PoseHistory {
 public:
  // Of all carriers of the scenario. step: unit: s; > 0. start_ns: stamp of the robots' time 0. Throws InputError, with the key of the ride, for a link that the
  // robot has not.
  PoseHistory(const Scenario& scenario, const std::vector<MissionRobot>& robots, double step, std::int64_t start_ns);

  // At the robots' time 0, when it has begun; forgets all before. run: must outlive what is asked.
  void restart(const RobotRun& run);
  // After each step of the run. The way of a lost robot's links ends with the last step before.
  void note_step();

  // Of the rig and of each link that carries sensors of its own, and the contacts of links; they grow.
  const RobotReadings& ways() const { return ways_; }
  Pose world_from_rig() const;                                             // now; the rig must be on a robot
  // Stamp of the end of the way of what carries a sensor, when its robot was lost; nothing: it goes on.
  std::optional<std::int64_t> end_of(const Carrier& carrier) const;
  // Now, of what carries a sensor: the rig where `carrier` names no robot. Nothing: no robot carries it.
  std::optional<Pose> world_from(const Carrier& carrier) const;
  std::optional<RigMount> mount(const std::vector<RobotRecord>& records) const;  // of the rig

  std::int64_t ways_known_until() const;   // stamp
  std::int64_t track_known_until() const;  // stamp
  // Of a piece or a link; nothing: it was not there.
  std::optional<Pose> pose_of(int id, std::int64_t stamp_ns) const;
  // Forgets ways before that stamp. The track is kept.
  void forget_before(std::int64_t stamp_ns);

 private:
  // A place on a link.
  struct Mount : RiddenLink {
    std::size_t robot = 0;
    std::shared_ptr<SimulatedPath> way;
    bool lost = false;  // the link left the world
  };
  void add(const Carrier& carrier, const Pose& link_from_carrier, const std::string& key);
  const Mount* find(const Carrier& carrier) const;  // null: no robot carries it
  PieceState state_of(const Mount& mount) const;    // of the link
  Pose place(const Mount& mount) const;

  std::vector<std::string> names_;  // of the robots
  const std::vector<MissionRobot>& robots_;
  std::int64_t start_ns_;
  double step_;
  bool felt_;    // whether contacts are kept, for sensors of contact
  bool driven_;  // whether the work of motors is kept, for batteries
  std::vector<Mount> mounts_;
  int rig_ = -1;  // which of them is the rig
  RobotReadings ways_;
  const RobotRun* run_ = nullptr;
};

}  // namespace rubble
