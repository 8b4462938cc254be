// From a camera of a mission to what renders it, and where it flies.
#pragma once

#include <memory>

#include "render/scene/camera_spec.h"
#include "render/sensors/flight.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// A camera of the mission (all_cameras), with what is in its place.
CameraSpec build_camera(const Scenario& scenario, const MountedCamera& camera, int threads);

// Where that camera is, at its own rate, along the scenario's trajectory, whose places are resolved:
// app/planning/flight.h. ride: instead of the trajectory, the way of the rig on a robot.
Flight build_flight(const Scenario& scenario, const MountedCamera& camera,
                    std::shared_ptr<const MotionPath> ride = nullptr);

}  // namespace rubble
