// What the robots of a mission sensed while they were driven, and whether one carries the rig.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/world/world.h"
#include "render/scene/robot_sample.h"
#include "scripting/trajectory/smooth_path.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// How hard the links of robots pressed against anything else, in every step.
class ContactHistory {
 public:
  // step: of the world; unit: s
  ContactHistory() = default;
  explicit ContactHistory(double step) : step_(step) {}

  // After each step.
  void note(const World& world, int robots);
  // The largest sum of the normal forces on these links of a robot in the steps after `from` up to `to`, counted from the
  // start; unit: N, s
  double largest_force(std::size_t robot, const std::vector<std::size_t>& links, double from, double to) const;

 private:
  double step_ = 1;
  std::vector<std::vector<std::vector<double>>> forces_;  // by step, robot, link; empty: none on any
};

// What the motors of robots gave in every step: of joints by their work, of belts by the force along them and their speed.
class MotorHistory {
 public:
  // step: of the world; unit: s
  MotorHistory() = default;
  explicit MotorHistory(double step) : step_(step) {}

  // After each step.
  void note(const World& world, int robots);
  // In the steps after `from` up to `to`, counted from the start, without what was braked; unit: J, s
  double work(std::size_t robot, double from, double to) const;

 private:
  double step_ = 1;
  std::vector<std::vector<double>> joints_;  // by robot, joint: work up to the last step; unit: J
  std::vector<std::vector<double>> given_;   // by robot, step: all up to its end; unit: J
};

// The way of a link that carries sensors of its own.
struct LinkWay {
  Carrier carrier;
  std::shared_ptr<const MotionPath> path;  // of the link's frame
};

// Links that a sensor of contact feels.
struct FeltLinks {
  std::size_t robot = 0;
  std::vector<std::size_t> links;
};

struct RobotReadings {
  std::vector<std::vector<RobotSample>> samples;  // by robot, in order of stamps
  std::shared_ptr<const MotionPath> ride;  // of the rig, on a link; none: it flies the trajectory
  std::vector<LinkWay> links;              // each carrier once
  ContactHistory contacts;                 // of their links
  MotorHistory motors;                     // where a sensor asks for them
  std::vector<FeltLinks> felt;             // by sensor of the scenario; empty without robots

  // Of what rides there; `rig` where nothing carries it; null: no robot was driven.
  const std::shared_ptr<const MotionPath>& path_of(const Carrier& carrier,
                                                   const std::shared_ptr<const MotionPath>& rig) const;
  // Stamp after which a sensor has nothing to say: when the way of its carrier ends, as that of a link does when its robot
  // is lost or no longer driven. start_ns: stamp of the time 0 of all ways. last_ns: of the last frame.
  std::int64_t end_of(const Carrier& carrier, const std::shared_ptr<const MotionPath>& rig, std::int64_t start_ns,
                      std::int64_t last_ns) const;
};

}  // namespace rubble
