#include "kernel/world/phases/step.h"

namespace rubble {

void StepPairs::list_awake(const std::vector<Body>& bodies) {
  awake.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].awake) awake.push_back(std::int32_t(i));
  }
}

float StepPairs::calc_margin(int body_a, int body_b, const NarrowSettings& settings) const {
  const StepMotion& a = sweeps[body_a];
  if (body_b == kGround) return motion_margin(a.linear, a.turning, settings);
  const StepMotion& b = sweeps[body_b];
  return motion_margin(a.linear - b.linear, a.turning + b.turning, settings);
}

}  // namespace rubble
