// What Python asks of robots and is told of them. Internal to python/.
#pragma once

#include <vector>

#include "kernel/model/robot.h"
#include "python/arrays.h"

namespace rubble::python {

// All throw InputError for what the robot cannot do.
RobotCommand make_twist_command(const RobotModel& model, double linear, double angular, const std::vector<double>& flippers);
// speed: of the tip; negative: it retracts; unit: m/s. left, up: curvature of what grows; unit: 1/m
RobotCommand make_growth_command(const RobotModel& model, double speed, double left, double up);
// Positions of all joints; unit: rad, m
RobotCommand make_joints_command(const RobotModel& model, const std::vector<double>& targets);

// time: unit: s
nb::dict describe_state(const RobotModel& model, const RobotState& state, double time);
std::vector<std::string> link_names_of(const RobotModel& model);

// Whole steps in so many seconds; at least one. Throws InputError beyond a minute.
int count_steps(double seconds, double step);

}  // namespace rubble::python
