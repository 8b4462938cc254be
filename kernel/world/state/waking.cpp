#include "kernel/world/state/waking.h"

namespace rubble {
namespace {

// A sleeping piece wakes if the vector sum of its contact impulses has changed, since it fell asleep, by more
// than this speed times its mass ... unit: m/s
constexpr float kUnbalancedSpeed = 0.01F;
// ... plus this share of its load. A load that one neighbour takes over from another changes nothing. unit: 1
constexpr float kUnbalancedLoad = 0.05F;

}  // namespace

void Waking::wake(int index) {
  Body& body = data_.bodies[index];
  if (!body.movable() || body.awake) return;
  if (body.tree >= 0) {  // all of it at once
    for (const TreeLink& link : data_.trees[body.tree].links) wake_one(data_.bodies[link.body]);
  } else {
    wake_one(body);
  }
}

void Waking::wake_one(Body& body) {
  if (!body.movable()) return;
  body.awake = true;
  body.lost_support = {};
  body.still_steps = body.loose_steps = 0;
  body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
  body.later_steps = 0;
}

void Waking::wake_marked() {
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
    if (data_.wake_next[i]) wake(int(i));
    data_.wake_next[i] = 0;
  }
}

bool Waking::is_unbalanced(const Body& body, const Vec3f& change) const {
  const float steps = float(settings_.options.step * kStepsPerSecond);
  const float most = kUnbalancedSpeed * steps * float(body.mass) + kUnbalancedLoad * body.load;
  return dot(change, change) > most * most;
}

void Waking::note_lost_contact(const Contact& contact) {
  for (std::int32_t i : {contact.body_a, contact.body_b}) {
    if (i == kGround || data_.bodies[i].awake || !data_.bodies[i].movable()) continue;
    Body& body = data_.bodies[i];
    body.lost_support += contact.normal * (i == contact.body_a ? -contact.rest_pressed : contact.rest_pressed);
    if (is_unbalanced(body, body.lost_support)) data_.wake_next[i] = 1;
  }
}

}  // namespace rubble
