// A verification of rest: who takes part in a step while it lasts.
//
// Rest is verified with every piece awake. As long as a few pieces still move, the others need not be
// computed: those that have been verified to stay in place, and are some contacts away from what
// moves, doze. They wake as sleepers do. When nothing moves any more all are woken, and the verification
// asks again: it succeeds only when all have stayed in place at the same time and awake.
#include <algorithm>

#include "kernel/solver/speed_limits.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// A verification of rest keeps all pieces awake at least this long before some may sleep: the 0.5 s of a
// verification in which nothing moves, and one step; unit: s.
constexpr double kAllAwakeTime = 0.52;
constexpr double kDozeInterval = 0.25;  // interval in which pieces that may sleep are searched; unit: s
// Pieces at most this many contacts away from a moving piece stay awake.
constexpr int kDisturbedContacts = 3;
// No piece sleeps while more than this share of the pieces would have to stay awake; unit: 1.
constexpr double kMostDisturbed = 0.5;

}  // namespace

// Marks the awake pieces that have not stayed in place; returns how many there are.
int World::Impl::mark_restless() {
  disturbed.assign(data.bodies.size(), 0);
  int count = 0;
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    const Body& body = data.bodies[i];
    if (!body.awake || within_rest_tolerance(body)) continue;
    disturbed[i] = 1;
    ++count;
  }
  return count;
}

void World::Impl::spread_disturbance() {
  for (int ring = 1; ring <= kDisturbedContacts; ++ring) {
    each_solved([&](const Contact& contact) {
      if (contact.body_b == kGround || contact.pressed <= 0) return;
      std::uint8_t &a = disturbed[contact.body_a], &b = disturbed[contact.body_b];
      if (a == ring && b == 0 && data.bodies[contact.body_b].mass > 0) b = std::uint8_t(ring + 1);
      if (b == ring && a == 0 && data.bodies[contact.body_a].mass > 0) a = std::uint8_t(ring + 1);
    });
  }
}

// Puts those to sleep that nothing disturbs.
void World::Impl::doze() {
  spread_disturbance();
  const auto stirred = std::count_if(disturbed.begin(), disturbed.end(),
                                     [](std::uint8_t ring) { return ring > 0; });
  if (double(stirred) > kMostDisturbed * double(data.bodies.size())) return;
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    slept[i] = data.bodies[i].awake && disturbed[i] == 0;
  }
  keep_trees_whole();
  put_to_sleep();
  data.all_awake_since = -1;
}

void World::Impl::wake_dozing() {
  for (std::size_t i = 0; i < data.bodies.size(); ++i) wake(int(i));
  data.all_awake_since = data.verification_steps;
}

void World::Impl::update_verification() {
  const int restless = mark_restless();
  const bool dozing = data.all_awake_since < 0;
  if (restless == 0) {
    if (dozing) wake_dozing();
    return;
  }
  const auto steps = [this](double time) { return std::int64_t(time / options.step); };
  // What has not come to rest by now may do so among neighbours that are awake.
  if (data.verification_steps > steps(double(kPatienceEnds))) {
    if (dozing) wake_dozing();
    return;
  }
  const std::int64_t awake = data.verification_steps - data.all_awake_since - steps(kAllAwakeTime);
  if (!dozing && awake < 0) return;
  if ((dozing ? data.verification_steps : awake) % steps(kDozeInterval) == 0) doze();
}

}  // namespace rubble
