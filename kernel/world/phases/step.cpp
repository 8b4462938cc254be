#include "kernel/world/phases/step.h"

namespace rubble {

void StepPairs::list_awake(const std::vector<Body>& bodies) {
  awake.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].awake) awake.push_back(std::int32_t(i));
  }
}

SolvedContact StepPairs::facts_of(const Contact& contact, std::int32_t index) const {
  SolvedContact facts;
  facts.body_a = contact.body_a, facts.body_b = contact.body_b, facts.index = index;
  facts.pressed = contact.pressed > 0;
  facts.rolls_a = contact.rolls_a, facts.rolls_b = contact.rolls_b;
  facts.at_sleeper = !sweeps[contact.body_a].awake || (contact.body_b != kGround && !sweeps[contact.body_b].awake);
  return facts;
}

void StepPairs::note_solved(const std::vector<Contact>& contacts, ThreadPool& pool) {
  solved.resize(active.size());
  pool.run(int(active.size()), 256, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) solved[k] = facts_of(contacts[active[k]], active[k]);
  });
}

float StepPairs::calc_margin(int body_a, int body_b, const NarrowSettings& settings) const {
  const StepMotion& a = sweeps[body_a];
  if (body_b == kGround) return motion_margin(a.linear, a.turning, settings);
  const StepMotion& b = sweeps[body_b];
  return motion_margin(a.linear - b.linear, a.turning + b.turning, settings);
}

}  // namespace rubble
