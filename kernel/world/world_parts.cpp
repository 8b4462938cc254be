// What pieces can be joined to: groups, ties, robots.
#include <algorithm>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/world/world_impl.h"

namespace rubble {

void World::set_step(double step, int substeps) {
  Impl& w = *impl_;
  if (!(step >= 1e-3 && step <= 1.0 / 30 + 1e-12)) {
    throw InputError({"", 0, "step", "out of range", "1/1000 to 1/30 s", std::to_string(step), ""});
  }
  if (substeps < 1 || substeps > 64) {
    throw InputError({"", 0, "substeps", "out of range", "1 to 64", std::to_string(substeps), ""});
  }
  const float longer = float(step / w.settings.options.step);
  for (Body& body : w.data.bodies) {
    body.load *= longer;
    body.lost_support *= longer;
  }
  for (Contact& contact : w.data.contacts) contact.rest_pressed *= longer;
  for (Tie& tie : w.data.ties) tie.contact.rest_pressed *= longer;
  w.settings.options.step = step;
  w.settings.solver.step = w.settings.narrow.step = float(step);
  w.settings.solver.substeps = substeps;
}

int World::add_robot(const RobotModel& model, const Pose& world_from_base) {
  return impl_->robots.add(model, world_from_base);
}
int World::robot_count() const { return int(impl_->data.robots.size()); }
int World::robot_piece(int robot) const { return impl_->data.robots[std::size_t(robot)].first_body; }
const RobotModel& World::robot_model(int robot) const { return impl_->types.robots[std::size_t(robot)]; }
void World::set_command(int robot, const RobotCommand& command) { impl_->robots.set_command(robot, command); }

RobotState World::robot_state(int robot) const { return impl_->robots.state(robot); }
std::vector<RobotContact> World::robot_contacts(int robot) const { return impl_->robots.contacts(robot); }

void World::bind(int first, int count) { impl_->groups.bind(first, count); }

void World::split(const std::vector<SplitPart>& parts) {
  impl_->groups.split(impl_->data.bodies[parts[0].pieces[0]].lead, parts);
}

std::vector<int> World::bound_with(int index) const {
  const Body& body = impl_->bodies.acting(index);
  if (body.group < 0) return {index};
  const std::vector<std::int32_t>& members = impl_->data.groups[body.group].members;
  return {members.begin(), members.end()};
}

Vec3 World::centre_velocity(int index) const {
  return impl_->bodies.linear_velocity(impl_->bodies.acting(index));
}

void World::set_on_stage(std::function<void(StepStage)> on_stage) { impl_->on_stage = std::move(on_stage); }

void World::set_on_solved(std::function<bool()> on_solved) { impl_->on_solved = std::move(on_solved); }

void World::add_tie(const TieState& tie) { impl_->ties.add(tie); }

std::vector<TieState> World::ties() const {
  std::vector<TieState> result;
  for (const Tie& tie : impl_->data.ties) result.push_back(tie.state);
  return result;
}

int World::tie_count() const { return int(impl_->data.ties.size()); }

double World::tie_energy() const { return impl_->data.tie_energy; }

double World::tie_force(int index) const {
  return double(impl_->data.ties[std::size_t(index)].contact.pressed) / impl_->settings.options.step;
}

}  // namespace rubble
