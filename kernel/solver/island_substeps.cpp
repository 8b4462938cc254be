#include "kernel/solver/island_substeps.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace rubble {
namespace {

// So that impulses keep their bits when they are scaled from one kind to another.
constexpr bool is_power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }
static_assert(is_power_of_two(kIslandKinds[0].substeps) && is_power_of_two(kIslandKinds[1].substeps));

bool moves(const std::vector<Body>& bodies, std::int32_t body) { return body != kGround && bodies[std::size_t(body)].awake; }

}  // namespace

void IslandSubsteps::find(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                          const std::vector<std::int32_t>& order) {
  sets_.reset(bodies.size());
  height_.assign(bodies.size(), 0);
  for (const std::int32_t index : order) {
    const Contact& c = contacts[std::size_t(index)];
    // What is met for the first time lies on the other, as contacts come bottom up.
    for (const auto& [upper, lower] : {std::pair{c.body_a, c.body_b}, std::pair{c.body_b, c.body_a}}) {
      if (!moves(bodies, upper) || height_[std::size_t(upper)] != 0) continue;
      height_[std::size_t(upper)] = lower == kGround ? 1 : height_[std::size_t(lower)] + 1;
    }
    if (moves(bodies, c.body_a) && moves(bodies, c.body_b)) sets_.join(c.body_a, c.body_b);
  }
  islands_.assign(bodies.size(), {});
  for (const std::int32_t index : order) {
    const Contact& c = contacts[std::size_t(index)];
    for (const std::int32_t body : {c.body_a, c.body_b}) {
      if (!moves(bodies, body)) continue;
      Island& island = islands_[std::size_t(sets_.find(body))];
      island.height = std::max(island.height, height_[std::size_t(body)]);
      island.is_heap = island.is_heap || bodies[std::size_t(body)].tree >= 0 || std::size_t(index) >= ties;
    }
    const bool a = moves(bodies, c.body_a);
    if (a || moves(bodies, c.body_b)) ++islands_[std::size_t(sets_.find(a ? c.body_a : c.body_b))].contacts;
  }
}

bool IslandSubsteps::split(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                           const std::vector<std::int32_t>& order) {
  kinds_.clear();
  find(bodies, contacts, ties, order);
  const auto kind_of_island = [](const Island& island) {
    if (island.is_heap) return kHeap;
    return int(std::find_if(std::begin(kIslandKinds), std::end(kIslandKinds), [&island](const IslandKind& kind) {
      return island.height >= kind.height && island.contacts <= kind.contacts * island.height;
    }) - std::begin(kIslandKinds));
  };
  if (std::all_of(islands_.begin(), islands_.end(), [&](const Island& i) { return kind_of_island(i) == kHeap; })) return false;
  kinds_.assign(bodies.size(), std::uint8_t(kHeap));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].awake) kinds_[i] = std::uint8_t(kind_of_island(islands_[std::size_t(sets_.find(std::int32_t(i)))]));
  }
  for (std::vector<std::int32_t>& group : groups_) group.clear();
  for (const std::int32_t index : order) {
    const Contact* c = std::size_t(index) < ties ? &contacts[std::size_t(index)] : nullptr;
    const int kind = c == nullptr ? kHeap : std::min(kind_of(c->body_a), c->body_b == kGround ? kHeap : kind_of(c->body_b));
    groups_[kind].push_back(index);
  }
  return true;
}

}  // namespace rubble
