// What the tests of robots share.
#pragma once

#include "kernel/robot/drive_commands.h"
#include "kernel/world/world.h"
#include "scripting/robots/crawler.h"
#include "scripting/robots/rover.h"
#include "scripting/robots/snake.h"
#include "scripting/robots/vine.h"
#include "scenes.h"

namespace rubble::testing {

inline constexpr double kRobotStep = 1.0 / 240;
inline constexpr int kRobotSubsteps = 4;

// A world for robots: steps of 1/240 s.
World make_robot_world(std::vector<PieceType> types = {}, int threads = 1, double gravity = 9.81);

// `command` is asked every 1/60 s, with the time since the first call.
using Controller = std::function<RobotCommand(double time)>;
void drive(World& world, int robot, double seconds, const Controller& controller);

// Yaw of a robot's first link, in (-pi, pi].
double yaw_of(const World& world, int robot);
Vec3 position_of(const World& world, int robot);  // of the first link's frame
// Mass-weighted mean of the links' centres of mass.
Vec3 centre_of(const World& world, int robot);

}  // namespace rubble::testing
