#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

#include <cmath>

namespace rubble::testing {

World make_robot_world(std::vector<PieceType> types, int threads, double gravity) {
  WorldOptions options;
  options.threads = threads;
  options.gravity = gravity;
  World world(std::move(types), options);
  world.set_step(kRobotStep, kRobotSubsteps);
  return world;
}

void drive(World& world, int robot, double seconds, const Controller& controller) {
  const int steps = int(seconds / kRobotStep + 0.5);
  for (int i = 0; i < steps; ++i) {
    if (i % 4 == 0) world.robots().set_command(robot, controller(i * kRobotStep));
    world.step();
  }
}

double yaw_of(const World& world, int robot) {
  const Vec3 x = world.robots().state(robot).links[0].world_from_link.rotation.rotate({1, 0, 0});
  return std::atan2(x.y, x.x);
}

Vec3 position_of(const World& world, int robot) {
  return world.robots().state(robot).links[0].world_from_link.translation;
}

Vec3 centre_of(const World& world, int robot) {
  const RobotModel& model = world.robots().model(robot);
  const RobotState state = world.robots().state(robot);
  Vec3 sum;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    sum += (state.links[i].world_from_link * model.links[i].centre_of_mass) * model.links[i].mass;
  }
  return sum * (1 / model.mass());
}

}  // namespace rubble::testing
