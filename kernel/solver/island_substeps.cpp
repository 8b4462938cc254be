#include "kernel/solver/island_substeps.h"

#include <algorithm>
#include <iterator>

namespace rubble {
namespace {

// So that impulses keep their bits when they are scaled from one kind to another.
constexpr bool is_power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }
static_assert(is_power_of_two(kIslandKinds[0].substeps) && is_power_of_two(kIslandKinds[1].substeps));

}  // namespace

int IslandSubsteps::kind_of_island(std::int32_t body) {
  const Island& island = islands_.of(body);
  if (tied_[std::size_t(islands_.lowest_of(body))] != 0) return kHeap;
  const auto fits = [&island](const IslandKind& kind) {
    return island.height >= kind.height && island.contacts <= kind.contacts * island.height;
  };
  return int(std::find_if(std::begin(kIslandKinds), std::end(kIslandKinds), fits) - std::begin(kIslandKinds));
}

bool IslandSubsteps::split(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                           const std::vector<std::int32_t>& order) {
  const auto still = std::int32_t(bodies.size());
  const auto number = [&](std::int32_t body) {
    return body != kGround && bodies[std::size_t(body)].awake ? body : still;
  };
  islands_.begin(bodies.size());
  for (const std::int32_t index : order) {
    const Contact& c = contacts[std::size_t(index)];
    islands_.add(number(c.body_a), number(c.body_b));
  }
  islands_.finish();
  tied_.assign(bodies.size() + 1, 0);
  for (const std::int32_t index : order) {
    const Contact& c = contacts[std::size_t(index)];
    for (const std::int32_t body : {number(c.body_a), number(c.body_b)}) {
      if (body == still || (bodies[std::size_t(body)].tree < 0 && std::size_t(index) < ties)) continue;
      tied_[std::size_t(islands_.lowest_of(body))] = 1;
    }
  }
  kinds_.assign(bodies.size(), std::uint8_t(kHeap));
  bool any = false;
  for (std::int32_t body = 0; body < still; ++body) {
    if (number(body) == still) continue;
    const int kind = kind_of_island(body);
    kinds_[std::size_t(body)] = std::uint8_t(kind), any = any || kind != kHeap;
  }
  if (!any) {
    kinds_.clear();
    return false;
  }
  for (std::vector<std::int32_t>& group : groups_) group.clear();
  for (const std::int32_t index : order) {
    const Contact& c = contacts[std::size_t(index)];
    // Of two bodies one may stay, which has no island.
    const int kind = std::min(kind_of(c.body_a), c.body_b == kGround ? kHeap : kind_of(c.body_b));
    groups_[kind].push_back(index);
  }
  return true;
}

}  // namespace rubble
