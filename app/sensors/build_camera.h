// From a camera of a mission to what renders it, and where it flies.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/sensors/robot_readings.h"
#include "render/scene/camera_spec.h"
#include "render/sensors/flight.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// A camera of the mission, with what is in its place. seed: of the mission.
CameraSpec build_camera(const MountedCamera& camera, std::uint64_t seed, int threads);
// Each camera with a name has noise of its own. noise_seed: of all sensors.
std::uint64_t camera_seed(const MountedCamera& camera, std::uint64_t noise_seed);
// Where it is when its carrier is there: the rig, or a link.
Pose place_on_mount(const MountedCamera& camera, const Pose& carrier);

// Where that camera is, at its own rate or this one, along the path of what carries it.
Flight build_flight(const MountedCamera& camera, std::int64_t start_ns, double rate_hz,
                    std::shared_ptr<const MotionPath> path);

// The path of the rig, and where each camera is on it, or on the link that carries it.
struct RigFlight {
  std::int64_t start_ns = 0;  // the stamp of the paths' time 0
  std::shared_ptr<const MotionPath> path;  // of the rig; never null
  std::vector<std::shared_ptr<const MotionPath>> carriers;  // by camera: of the rig, or of the link; null: it is not there
  std::vector<Flight> cameras;             // each with the stamps of its own rate; empty: it is not there
};
RigFlight build_rig_flight(const std::vector<MountedCamera>& cameras, std::int64_t start_ns, double rate_hz,
                           std::shared_ptr<const MotionPath> path, const RobotReadings& robots = {});

}  // namespace rubble
