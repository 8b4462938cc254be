#include "kernel/world/phases/step.h"

namespace rubble {

void StepPairs::list_awake(const std::vector<Body>& bodies) {
  awake.clear();
  is_awake.assign(bodies.size(), 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].awake) continue;
    awake.push_back(std::int32_t(i));
    is_awake[i] = 1;
  }
}

float StepPairs::calc_margin(int body_a, int body_b, const NarrowSettings& settings) const {
  const StepMotion& a = sweeps[body_a];
  if (body_b == kGround) return motion_margin(a.linear, a.turning, settings);
  const StepMotion& b = sweeps[body_b];
  return motion_margin(a.linear - b.linear, a.turning + b.turning, settings);
}

}  // namespace rubble
