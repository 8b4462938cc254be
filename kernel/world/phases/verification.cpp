// A verification of rest: who takes part in a step while it lasts.
//
// Rest is verified with every piece awake. As long as a few pieces still move, the others need not be
// computed: those that have been verified to stay in place, and are some contacts away from what
// moves, doze. They wake as sleepers do. When nothing moves any more all are woken, and the verification
// asks again: it succeeds only when all have stayed in place at the same time and awake. If that took so long
// that rolling resistance was on, it is switched off, and all must stay in place without it. What does not come to
// rest among a few that are awake may do so among more: all are woken from time to time, and then fewer doze.
#include <algorithm>

#include "kernel/solver/speed_limits.h"
#include "kernel/world/phases/sleep.h"

namespace rubble {
namespace {

// A verification of rest keeps all pieces awake at least this long before some may sleep: the 0.5 s of a
// verification in which nothing moves, and one step; unit: s.
constexpr double kAllAwakeTime = 0.52;
constexpr double kDozeInterval = 0.25;  // interval in which pieces that may sleep are searched; unit: s
// Pieces at most this many contacts away from a moving piece stay awake.
constexpr int kDisturbedContacts = 3;
// When patience has ended, and after each such time again, all are woken, and pieces up to `kMoreContacts` contacts
// farther away stay awake than before. unit: s
constexpr double kWidenInterval = 2;
constexpr int kMoreContacts = 3;  // as many as at first; unit: 1
constexpr int kMostWidenings = 80;  // rings are counted in eight bits
// No piece sleeps while more than this share of the pieces would have to stay awake; unit: 1.
constexpr double kMostDisturbed = 0.5;
// When all stay in place with rolling resistance, they must do so without it. A try is given up after this time: a
// piece that jitters needs 1 s to pass. unit: s
constexpr double kUndampedTime = 1.2;
// After so many tries rolling resistance is left on: what swings for minutes is held by it. unit: 1
constexpr int kUndampedTries = 3;
// No try begins this long before the end of the time that the verification may take: one that fails is followed by
// some 2 s in which all come to rest again. unit: s
constexpr double kTimeForTry = 4;

}  // namespace

// Marks the awake pieces that have not stayed in place; returns how many there are.
int Sleep::mark_restless() {
  disturbed_.assign(data_.bodies.size(), 0);
  int count = 0;
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
    const Body& body = data_.bodies[i];
    if (!body.awake || within_rest_tolerance(body)) continue;
    disturbed_[i] = 1;
    ++count;
  }
  return count;
}

// How often all have been woken since patience ended.
int Sleep::count_widenings() const {
  const double late = double(data_.verification_steps) * settings_.options.step - double(kPatienceEnds);
  return late < 0 ? 0 : std::min(int(late / kWidenInterval) + 1, kMostWidenings);
}

void Sleep::spread_disturbance(const StepPairs& step) {
  const int rings = kDisturbedContacts + kMoreContacts * count_widenings();
  for (int ring = 1; ring <= rings; ++ring) {
    each_solved_fact(data_, step, [&](const SolvedContact& contact, const auto&) {
      if (contact.body_b == kGround || !contact.pressed) return;
      std::uint8_t &a = disturbed_[contact.body_a], &b = disturbed_[contact.body_b];
      if (a == ring && b == 0 && data_.bodies[contact.body_b].mass > 0) b = std::uint8_t(ring + 1);
      if (b == ring && a == 0 && data_.bodies[contact.body_a].mass > 0) a = std::uint8_t(ring + 1);
    });
  }
}

// Puts those to sleep that nothing disturbs.
void Sleep::doze(const StepPairs& step) {
  spread_disturbance(step);
  const auto stirred =
      std::count_if(disturbed_.begin(), disturbed_.end(), [](std::uint8_t ring) { return ring > 0; });
  if (double(stirred) > kMostDisturbed * double(data_.bodies.size())) return;
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
    slept_[i] = data_.bodies[i].awake && disturbed_[i] == 0;
  }
  trees_.keep_whole(slept_);
  put_to_sleep(step);
  data_.all_awake_since = -1;
}

void Sleep::wake_dozing() {
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) waking_.wake(int(i));
  data_.all_awake_since = data_.verification_steps;
}

bool Sleep::is_damped() const {
  const double lasted = double(data_.verification_steps) * settings_.options.step;
  return data_.undamped_since < 0 && lasted > double(kPatience);
}

// What rolling resistance may hold has to stay in place without it: all time that counts starts anew.
void Sleep::begin_undamped_try() {
  data_.undamped_since = data_.verification_steps;
  ++data_.undamped_tries;
  for (Body& body : data_.bodies) {
    body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
    body.still_steps = body.loose_steps = body.later_steps = 0;
  }
}

void Sleep::update_verification(const StepPairs& step) {
  const int restless = mark_restless();
  const bool dozing = data_.all_awake_since < 0;
  const auto steps = [this](double time) { return std::int64_t(time / settings_.options.step); };
  if (restless == 0) {
    if (dozing) wake_dozing();
    const bool in_time = data_.verification_steps <= data_.verification_limit - steps(kTimeForTry);
    if (in_time && is_damped() && data_.undamped_tries < kUndampedTries) begin_undamped_try();
    return;
  }
  if (data_.undamped_since >= 0) {
    if (data_.verification_steps - data_.undamped_since > steps(kUndampedTime)) data_.undamped_since = -1;
    return;
  }
  const std::int64_t late = data_.verification_steps - steps(double(kPatienceEnds));
  if (dozing && late >= 0 && late % steps(kWidenInterval) == 0) return wake_dozing();
  const std::int64_t awake = data_.verification_steps - data_.all_awake_since - steps(kAllAwakeTime);
  if (!dozing && awake < 0) return;
  if ((dozing ? data_.verification_steps : awake) % steps(kDozeInterval) == 0) doze(step);
}

}  // namespace rubble
