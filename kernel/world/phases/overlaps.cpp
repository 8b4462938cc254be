// Pieces of several parts that are stuck in each other are led out of each other along one direction.
#include <algorithm>
#include <tuple>

#include "kernel/collision/way_out.h"
#include "kernel/world/phases/contact_search.h"

namespace rubble {
namespace {

// Parts that overlap by more than this are separated along one common direction; unit: m.
constexpr float kDeep = 0.003F;
// The common direction is kept until the overlap is less than this; unit: m.
constexpr float kNearlyOut = 0.001F;

float calc_least_separation(const Contact& contact) {
  float least = 0;
  for (int i = 0; i < contact.count; ++i) least = std::min(least, contact.points[i].separation);
  return least;
}

}  // namespace

bool ContactSearch::DeepPair::operator<(const DeepPair& p) const {
  return std::tie(body_a, body_b, collider_a, collider_b) <
         std::tie(p.body_a, p.body_b, p.collider_a, p.collider_b);
}

bool ContactSearch::is_stuck(const Contact& contact) {
  const bool led = dot(contact.way_out, contact.way_out) > 0;
  return calc_least_separation(contact) < (led ? -kNearlyOut : -kDeep);
}

void ContactSearch::lead_out_of(StepPairs& step, const std::vector<std::int32_t>& deep) {
  const Body& a = data_.bodies[data_.pairs[deep[0]].body_a];
  const Body& b = data_.bodies[data_.pairs[deep[0]].body_b];
  std::vector<OverlappingParts> stuck;
  Vec3f before;
  for (const std::int32_t i : deep) {
    const Pair& pair = data_.pairs[i];
    const Contact& contact = data_.contacts[i];
    stuck.push_back({bodies_.posed(data_.colliders[pair.collider_a]).part,
                     bodies_.posed(data_.colliders[pair.collider_b]).part, contact.normal});
    if (dot(contact.way_out, contact.way_out) > 0) before = contact.way_out;
  }
  const Vec3f offset = Vec3f(b.world_from_com.translation - a.world_from_com.translation);
  const Vec3f way = find_way_out(stuck, bodies_.posed_parts(a), bodies_.posed_parts(b), offset, before);
  const float margin =
      step.calc_margin(data_.pairs[deep[0]].body_a, data_.pairs[deep[0]].body_b, settings_.narrow);
  for (const std::int32_t i : deep) {
    Pair& pair = data_.pairs[i];
    Contact& contact = data_.contacts[i];
    contact.way_out = way;
    search_along(contact, bodies_.posed(data_.colliders[pair.collider_a]),
                 bodies_.posed(data_.colliders[pair.collider_b]), way, margin, settings_.narrow);
    pair.live = contact.count > 0;
    step.is_deep[i] = overlaps_deep(contact);
    pair.searched_until = pair.apart_until = 0;
  }
}

// After the search of each pair by itself. Overlaps are rare: in most steps nothing is done.
void ContactSearch::lead_out(StepPairs& step) {
  deep_pairs_.clear();
  for (const std::int32_t i : step.active) {
    const Pair& pair = data_.pairs[i];
    if (!step.may_be_stuck[i] || pair.collider_b < 0 || !pair.live) continue;
    Contact& contact = data_.contacts[i];
    if (!is_stuck(contact)) {
      contact.way_out = {};
      continue;
    }
    const int parts = data_.bodies[pair.body_a].collider_count + data_.bodies[pair.body_b].collider_count;
    if (parts > 2) {
      deep_pairs_.push_back({pair.body_a, pair.body_b, pair.collider_a, pair.collider_b, i});
    }
  }
  if (deep_pairs_.empty()) return;
  // The order of the pairs depends on what happened elsewhere: by bodies and colliders.
  std::sort(deep_pairs_.begin(), deep_pairs_.end());
  const auto bodies = [](const DeepPair& p) { return std::make_pair(p.body_a, p.body_b); };
  std::vector<std::int32_t> of_one;
  for (std::size_t i = 0; i < deep_pairs_.size(); ++i) {
    of_one.push_back(deep_pairs_[i].index);
    if (i + 1 < deep_pairs_.size() && bodies(deep_pairs_[i + 1]) == bodies(deep_pairs_[i])) continue;
    lead_out_of(step, of_one);
    of_one.clear();
  }
}

}  // namespace rubble
