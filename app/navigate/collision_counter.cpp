#include "app/navigate/collision_counter.h"

#include <cmath>
#include <utility>

namespace rubble {
namespace {

// How far behind a contact what is touched is looked for above a step: the thinnest pieces are boards; unit: m.
constexpr double kBehind[]{0.005, 0.01, 0.02, 0.03, 0.05};
constexpr double kSteepest = 0.5;  // of a normal's horizontal part: what is flatter is ground that the robot stands on

}  // namespace

CollisionCounter::CollisionCounter(int pieces, double step_height, std::function<bool(const Vec3&)> is_solid)
    : pieces_(pieces), step_height_(step_height), is_solid_(std::move(is_solid)) {}

void CollisionCounter::begin_period() { pressed_before_ = pressed_, pressed_ = false; }

void CollisionCounter::note(const std::vector<RobotContact>& contacts, const Vec3& base) {
  for (const RobotContact& contact : contacts) {
    if (pressed_ || contact.piece < 0 || contact.piece >= pieces_ || contact.force <= 0) continue;
    if (!is_collision(contact, base.z + step_height_)) continue;
    pressed_ = true;
    count_ += !pressed_before_;
  }
}

// Where the pressure is says too little: a track meets a wall at the height of its axle, below a step.
bool CollisionCounter::is_collision(const RobotContact& contact, double highest_step) const {
  if (contact.point.z > highest_step) return true;
  const double flat = std::sqrt(contact.normal.x * contact.normal.x + contact.normal.y * contact.normal.y);
  if (flat < kSteepest) return false;
  for (const double depth : kBehind) {
    const Vec3 behind = contact.point - contact.normal * (depth / flat);
    if (is_solid_({behind.x, behind.y, highest_step})) return true;
  }
  return false;
}

}  // namespace rubble
