#include "kernel/world/world_structures.h"

#include <algorithm>
#include <utility>

#include "kernel/world/world_impl.h"

namespace rubble {
World::Structures World::structures() { return Structures(*impl_); }
const World::Structures World::structures() const { return Structures(*impl_); }

void World::Structures::bind(int first, int count) { impl_->groups.bind(first, count); }

void World::Structures::split(const std::vector<SplitPart>& parts) {
  impl_->groups.split(impl_->data.bodies[parts[0].pieces[0]].lead, parts);
}

void World::Structures::move_fixed(int index, const Vec3& by) {
  Body& body = impl_->data.bodies[impl_->data.bodies[index].lead];
  for (const Contact& contact : impl_->data.contacts) {
    if (contact.body_b == kGround) continue;
    if (contact.body_a == body.lead) impl_->waking.wake(contact.body_b);
    if (contact.body_b == body.lead) impl_->waking.wake(contact.body_a);
  }
  impl_->groups.move_fixed(body.lead, by);
}

std::vector<int> World::Structures::bound_with(int index) const {
  const Body& body = impl_->bodies.acting(index);
  if (body.group < 0) return {index};
  const std::vector<std::int32_t>& members = impl_->data.groups[body.group].members;
  return {members.begin(), members.end()};
}

Vec3 World::Structures::centre_velocity(int index) const {
  return impl_->bodies.linear_velocity(impl_->bodies.acting(index));
}

void World::Structures::set_on_solved(std::function<bool()> on_solved) { impl_->on_solved = std::move(on_solved); }

void World::Structures::add_tie(const TieState& tie) { impl_->ties.add(tie); }

std::vector<TieState> World::Structures::ties() const {
  std::vector<TieState> result;
  for (const Tie& tie : impl_->data.ties) result.push_back(tie.state);
  return result;
}

int World::Structures::tie_count() const { return int(impl_->data.ties.size()); }

double World::Structures::tie_energy() const { return impl_->data.tie_energy; }

double World::Structures::tie_force(int index) const {
  return double(impl_->data.ties[std::size_t(index)].contact.pressed) / impl_->settings.options.step;
}

}  // namespace rubble
