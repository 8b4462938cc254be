// What the robots of a mission sensed while they were driven, and whether one carries the rig.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/sensors/contact_history.h"
#include "render/scene/robot_sample.h"
#include "scripting/trajectory/motion_path.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

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
