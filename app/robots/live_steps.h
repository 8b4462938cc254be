// Where bodies were, and what carries sensors, in the last steps of robots that are driven.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "kernel/world/world.h"
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
  std::size_t number = 0;  // among the scenario's LiDARs, all_cameras() or all_imus()
  LinkMount mount;
};

// Steps are kept until forget_before() says that nobody asks for them.
class LiveSteps {
 public:
  // start_ns: the stamp of the robots' time 0. step: unit: s; > 0
  LiveSteps(std::int64_t start_ns, double step) : start_ns_(start_ns), step_(step) {}

  std::size_t add_carrier(const LinkMount& mount);  // its number; before restart()
  void restart(const World& world);                 // at the robots' time 0
  void note_step(const World& world);               // after each step

  std::int64_t start_ns() const { return start_ns_; }
  // Up to there, and some time beyond, the curve through a carrier's steps is the one that it will be.
  std::int64_t known_until() const;
  // Between these two, the places of one carrier and of all bodies may be asked.
  void begin_measuring(std::size_t carrier);
  void end_measuring() { way_ = nullptr; }
  bool measuring() const { return way_ != nullptr; }

  // On a curve through its steps.
  Pose carrier_at(std::int64_t stamp_ns) const { return carrier_after(since_start(stamp_ns)); }
  Pose carrier_after(double seconds) const;  // since the start; unit: s
  CameraMotion carrier_motion_after(double seconds) const;
  // Of a piece or a link, between steps on a straight line; nothing: it was not there.
  std::optional<Pose> pose_of(int id, std::int64_t stamp_ns) const;

  // The curve between two steps needs the steps beside them, which are kept too.
  void forget_before(std::int64_t stamp_ns);

 private:
  struct Rider {
    LinkMount mount;
    std::vector<Pose> poses;  // of steps from `first_` on
  };
  double since_start(std::int64_t stamp_ns) const { return double(stamp_ns - start_ns_) * 1e-9; }  // unit: s

  std::int64_t start_ns_;
  double step_;
  std::int64_t steps_ = 0, first_ = 0;
  std::vector<std::vector<std::optional<Pose>>> poses_;  // of steps from `first_` on, by id
  std::vector<Rider> riders_;
  std::unique_ptr<SimulatedPath> way_;  // of the carrier whose sensor measures
};

}  // namespace rubble
