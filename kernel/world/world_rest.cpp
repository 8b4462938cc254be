#include "kernel/world/world_rest.h"

#include <algorithm>

#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// What hangs by a joint rests when it has stayed in place for this long; unit: s.
constexpr double kHangingTime = 0.15;

}  // namespace

World::Rest World::rest() { return Rest(*impl_); }
const World::Rest World::rest() const { return Rest(*impl_); }

void World::Rest::begin_verification(double limit) {
  for (std::size_t i = 0; i < impl_->data.bodies.size(); ++i) impl_->waking.wake(int(i));
  for (Body& body : impl_->data.bodies) {
    body.later_pose = body.world_from_com;
    body.later_steps = 0;
  }
  impl_->data.verification_steps = impl_->data.all_awake_since = 0;
  impl_->data.verification_limit = std::int64_t(std::min(limit, kLongestVerification) / impl_->settings.options.step);
  impl_->data.undamped_since = -1;
  impl_->data.undamped_tries = 0;
}

bool World::Rest::verifying() const { return impl_->data.verification_steps >= 0; }

bool World::Rest::reached(double speed, double angular_speed) const {
  for (const Body& body : impl_->data.bodies) {
    if (!body.awake) continue;
    if (!body.touching) return false;
    const Vec3 v(body.linear), w(body.angular);
    if (dot(v, v) >= speed * speed || dot(w, w) >= angular_speed * angular_speed) return false;
    // What hangs stands still for a moment where it turns back.
    if (body.tree >= 0 && body.still_steps < int(kHangingTime / impl_->settings.options.step)) return false;
  }
  return true;
}

bool World::Rest::verified(double speed, double angular_speed) const {
  if (!verifying() || impl_->data.all_awake_since < 0) return false;
  if (!reached(speed, angular_speed)) return false;
  for (std::size_t i = 0; i < impl_->data.bodies.size(); ++i)
    if (!within_tolerance(int(i))) return false;
  return true;
}

bool World::Rest::within_tolerance(int index) const {
  const Body& body = impl_->bodies.acting(index);
  return !body.awake || impl_->sleep.within_rest_tolerance(body);
}

void World::Rest::put_all_to_sleep() { impl_->sleep.put_all_to_sleep(impl_->step_pairs); }

}  // namespace rubble
