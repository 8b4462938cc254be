// What robots sense as tables of a script (docs/reference/robots.md, "A function as controller").
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/model/robot.h"
#include "kernel/robot/odometry.h"
#include "kernel/robot/robot_run.h"
#include "render/scene/frame.h"
#include "render/scene/reading.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/sensors/sensor_item.h"
#include "scripting/values/value.h"

namespace rubble {

// gravity: unit: m/s2. last, last_time: the base's velocity at the call before, and when that was; become those of
// this call.
Value describe_sense(const RobotSense& sense, const RobotKind& kind, const RobotModel& model, double gravity, Vec3& last,
                     double& last_time);
Value describe_odometry(const OdometryReading& reading);
// start_ns: the stamp of the robots' time 0.
Value describe_reading(const ImuSample& reading, std::int64_t start_ns);
// By the columns of its kind; a scan by its ranges or its points.
Value describe_values(const Reading& reading, const SensorItem& sensor, std::int64_t start_ns);
// The depth of a frame, and its colours.
Value describe_depth(const Frame& frame, std::int64_t start_ns);
Value describe_colours(const Frame& frame, std::int64_t start_ns);

}  // namespace rubble
