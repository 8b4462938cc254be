// Pieces of several parts that are stuck in each other are led out of each other along one direction.
#include <algorithm>

#include "kernel/collision/way_out.h"
#include "kernel/world/world_impl.h"

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

bool World::Impl::is_stuck(const Contact& contact) const {
  const bool led = dot(contact.way_out, contact.way_out) > 0;
  return calc_least_separation(contact) < (led ? -kNearlyOut : -kDeep);
}

std::vector<PosedPart> World::Impl::posed_parts(const Body& body) const {
  std::vector<PosedPart> parts;
  for (int i = 0; i < body.collider_count; ++i) {
    parts.push_back(posed(data.colliders[std::size_t(body.first_collider + i)]).part);
  }
  return parts;
}

void World::Impl::lead_out_of(const std::vector<std::int32_t>& deep) {
  const Body& a = data.bodies[data.pairs[deep[0]].body_a];
  const Body& b = data.bodies[data.pairs[deep[0]].body_b];
  std::vector<OverlappingParts> stuck;
  Vec3f before;
  for (const std::int32_t i : deep) {
    const Pair& pair = data.pairs[i];
    const Contact& contact = data.contacts[i];
    stuck.push_back({posed(data.colliders[pair.collider_a]).part,
                           posed(data.colliders[pair.collider_b]).part, contact.normal});
    if (dot(contact.way_out, contact.way_out) > 0) before = contact.way_out;
  }
  const Vec3f offset = Vec3f(b.world_from_com.translation - a.world_from_com.translation);
  const Vec3f way = find_way_out(stuck, posed_parts(a), posed_parts(b), offset, before);
  const float margin = calc_margin(data.pairs[deep[0]].body_a, data.pairs[deep[0]].body_b);
  for (const std::int32_t i : deep) {
    Pair& pair = data.pairs[i];
    Contact& contact = data.contacts[i];
    contact.way_out = way;
    search_along(contact, posed(data.colliders[pair.collider_a]),
                 posed(data.colliders[pair.collider_b]), way, margin, narrow_settings);
    pair.live = contact.count > 0;
    is_deep[i] = overlaps_deep(contact);
    pair.searched_until = pair.apart_until = 0;
  }
}

// After the search of each pair by itself. Overlaps are rare: in most steps nothing is done.
void World::Impl::lead_out() {
  deep_pairs.clear();
  for (const std::int32_t i : active) {
    const Pair& pair = data.pairs[i];
    if (!may_be_stuck[i] || pair.collider_b < 0 || !pair.live) continue;
    Contact& contact = data.contacts[i];
    if (!is_stuck(contact)) {
      contact.way_out = {};
      continue;
    }
    const int parts = data.bodies[pair.body_a].collider_count + data.bodies[pair.body_b].collider_count;
    if (parts > 2) {
      deep_pairs.push_back({pair.body_a, pair.body_b, pair.collider_a, pair.collider_b, i});
    }
  }
  if (deep_pairs.empty()) return;
  // The order of the pairs depends on what happened elsewhere: by bodies and colliders.
  std::sort(deep_pairs.begin(), deep_pairs.end());
  const auto bodies = [](const DeepPair& p) { return std::make_pair(p.body_a, p.body_b); };
  std::vector<std::int32_t> of_one;
  for (std::size_t i = 0; i < deep_pairs.size(); ++i) {
    of_one.push_back(deep_pairs[i].index);
    if (i + 1 < deep_pairs.size() && bodies(deep_pairs[i + 1]) == bodies(deep_pairs[i])) continue;
    lead_out_of(of_one);
    of_one.clear();
  }
}

}  // namespace rubble
