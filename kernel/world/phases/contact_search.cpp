#include "kernel/world/phases/contact_search.h"

#include "kernel/collision/surface_contact.h"
#include "kernel/world/state/pairs.h"

namespace rubble {
namespace {

// Parts make points when they are closer than kPointMargin and what a step adds: the fixed margin
// of the search asks for more, and a hair is left for rounding.
constexpr float kSparedMargin = NarrowSettings{}.margin - kPointMargin - 1e-4F;
// Where two parts have moved by less than this in all since the last search, their points only move
// along: normals and lengths change by the square of it over their size; unit: m.
constexpr double kFollowedTravel = 1e-4;
// Overlaps deeper than this keep a piece awake for kSleepOverlapTime.
constexpr float kSleepOverlap = 0.003F;  // unit: m

}  // namespace

bool overlaps_deep(const Contact& contact) {
  for (int p = 0; p < contact.count; ++p) {
    if (contact.points[p].separation <= -kSleepOverlap) return true;
  }
  return false;
}

void ContactSearch::run(StepPairs& step) {
  update_contacts(step);
  lead_out(step);
}

void ContactSearch::update_contacts(StepPairs& step) {
  step.is_deep.resize(data_.pairs.size());
  step.may_be_stuck.resize(data_.pairs.size());
  pool_.run(int(step.active.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data_.pairs[step.active[i]];
      if (is_surface_collider(pair.collider_b)) {
        if (surface_slot(pair.collider_b) == 0) update_surface_slots(step, pair);
        continue;
      }
      update_pair(step, pair, data_.contacts[step.active[i]]);
      note_overlap(step, step.active[i]);
    }
  });
}

void ContactSearch::update_pair(const StepPairs& step, Pair& pair, Contact& contact) {
  const PosedBody a = bodies_.posed(data_.colliders[pair.collider_a]);
  const float margin = step.calc_margin(pair.body_a, pair.body_b, settings_.narrow);
  if (pair.collider_b == kGround) {
    update_ground_contact(contact, a, margin, settings_.narrow);
    pair.live = contact.count > 0;
    return;
  }
  const PosedBody b = bodies_.posed(data_.colliders[pair.collider_b]);
  const double travel = data_.bodies[pair.body_a].travel + data_.bodies[pair.body_b].travel;
  if (pair.live && travel < pair.searched_until) return follow_contact(contact, a, b);
  const auto is_free = [](const Body& body) { return body.tree < 0 && !body.touching; };
  const bool free = is_free(data_.bodies[pair.body_a]) && is_free(data_.bodies[pair.body_b]);
  const float apart = update_contact(contact, a, b, margin, settings_.narrow, free);
  pair.apart_until = travel + double(apart + kSparedMargin);
  pair.searched_until = travel + kFollowedTravel;
  pair.live = contact.count > 0;
}

// All slots of a part at once.
void ContactSearch::update_surface_slots(StepPairs& step, const Pair& first) {
  Contact* slots[kSurfaceSlots];
  std::int32_t numbers[kSurfaceSlots];
  for (int slot = 0; slot < kSurfaceSlots; ++slot) {
    numbers[slot] = data_.contact_of_pair.at(pair_key(first.collider_a, surface_collider(first.body_b, slot)));
    slots[slot] = &data_.contacts[numbers[slot]];
  }
  const Collider& collider = data_.colliders[first.collider_a];
  const float margin = step.calc_margin(first.body_a, kGround, settings_.narrow);
  update_surface_contacts(slots, bodies_.posed(collider), collider.box, data_.bodies[first.body_b], margin,
                          settings_.narrow);
  for (const std::int32_t number : numbers) {
    data_.pairs[number].live = data_.contacts[number].count > 0;
    note_overlap(step, number);
  }
}

// While the contact is at hand.
void ContactSearch::note_overlap(StepPairs& step, std::int32_t index) {
  const Contact& contact = data_.contacts[index];
  step.is_deep[index] = overlaps_deep(contact);
  step.may_be_stuck[index] = dot(contact.way_out, contact.way_out) > 0 || is_stuck(contact);
}

}  // namespace rubble
