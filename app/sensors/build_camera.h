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

// A camera of the mission (all_cameras), with what is in its place.
CameraSpec build_camera(const Scenario& scenario, const MountedCamera& camera, int threads);
// Of several cameras each has noise of its own. noise_seed: of all sensors.
std::uint64_t camera_seed(const Scenario& scenario, const MountedCamera& camera, std::uint64_t noise_seed);
// Where it is when its carrier is there: the rig, or a link.
Pose place_on_mount(const MountedCamera& camera, const Pose& carrier);

// Where that camera is, at its own rate, along the path of the scenario's trajectory, whose places are
// resolved (app/planning/flight.h), or along the way of the robot that carries the rig or the camera.
Flight build_flight(const Scenario& scenario, const MountedCamera& camera,
                    std::shared_ptr<const MotionPath> path);

// The path of the rig, and where each camera of all_cameras() is on it, or on the link that carries it.
struct RigFlight {
  std::shared_ptr<const MotionPath> path;  // of the rig; never null
  std::vector<std::shared_ptr<const MotionPath>> carriers;  // by camera: of the rig, or of the link
  std::vector<Flight> cameras;             // each with the stamps of its own rate
};
RigFlight build_rig_flight(const Scenario& scenario, std::shared_ptr<const MotionPath> path,
                           const RobotReadings& robots = {});

}  // namespace rubble
