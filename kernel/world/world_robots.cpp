#include "kernel/world/world_robots.h"

#include "kernel/world/world_impl.h"

namespace rubble {

World::Robots World::robots() { return Robots(*impl_); }
const World::Robots World::robots() const { return Robots(*impl_); }

int World::Robots::add(const RobotModel& model, const Pose& world_from_base) {
  return impl_->robots.add(model, world_from_base);
}

int World::Robots::count() const { return int(impl_->data.robots.size()); }
int World::Robots::first_piece(int robot) const { return impl_->data.robots[std::size_t(robot)].first_body; }
const RobotModel& World::Robots::model(int robot) const { return impl_->types.robots[std::size_t(robot)]; }
void World::Robots::set_command(int robot, const RobotCommand& command) { impl_->robots.set_command(robot, command); }
RobotState World::Robots::state(int robot) const { return impl_->robots.state(robot); }
std::vector<RobotContact> World::Robots::contacts(int robot) const { return impl_->robots.contacts(robot); }

}  // namespace rubble
