#include "kernel/solver/island_substeps.h"

#include <algorithm>
#include <iterator>

namespace rubble {
namespace {

// So that impulses keep their bits when they are scaled from one kind to another.
constexpr bool are_powers_of_two() {
  for (const IslandKind& kind : kIslandKinds)
    if (kind.substeps <= 0 || (kind.substeps & (kind.substeps - 1)) != 0) return false;
  return true;
}
static_assert(are_powers_of_two());

}  // namespace

int IslandSubsteps::kind_of_island(std::int32_t lowest) const {
  const std::uint8_t bonds = bonds_[std::size_t(lowest)];
  if ((bonds & kLink) != 0) return kHeap;
  if ((bonds & kTie) != 0) return kTied;
  const Island& island = islands_.with_lowest(lowest);
  const auto fits = [&island](const IslandKind& kind) {
    return island.height >= kind.height && island.contacts <= kind.contacts * island.height;
  };
  const IslandKind* const end = std::begin(kIslandKinds) + kTied;
  const IslandKind* const found = std::find_if(std::begin(kIslandKinds), end, fits);
  return found == end ? kHeap : int(found - std::begin(kIslandKinds));
}

// What split() asks of contacts and bodies, in one place: these lie far apart.
void IslandSubsteps::note_ends(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                               const std::vector<std::int32_t>& order, ThreadPool& pool) {
  const auto still = std::int32_t(bodies.size());
  ends_.resize(order.size());
  pool.run(int(order.size()), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const std::int32_t index = order[std::size_t(i)];
      const Contact& c = contacts[std::size_t(index)];
      Ends& ends = ends_[std::size_t(i)];
      ends = {still, still, std::size_t(index) >= ties ? kTie : kNone};
      const auto note = [&](std::int32_t body, std::int32_t& number) {
        if (body == kGround || !bodies[std::size_t(body)].awake) return;
        number = body;
        if (bodies[std::size_t(body)].tree >= 0) ends.bonds |= kLink;
      };
      note(c.body_a, ends.a), note(c.body_b, ends.b);
    }
  });
}

bool IslandSubsteps::split(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                           const std::vector<std::int32_t>& order, ThreadPool& pool) {
  const auto still = std::int32_t(bodies.size());
  note_ends(bodies, contacts, ties, order, pool);
  islands_.begin(bodies.size());
  for (const Ends& ends : ends_) islands_.add(ends.a, ends.b);
  islands_.finish();
  bonds_.assign(bodies.size() + 1, kNone);
  for (const Ends& ends : ends_) {
    if (ends.bonds != kNone) bonds_[std::size_t(islands_.lowest_of(ends.a != still ? ends.a : ends.b))] |= ends.bonds;
  }
  // The lowest number of an island comes first.
  kinds_.assign(bodies.size() + 1, std::uint8_t(kHeap));
  bool any = false;
  for (std::int32_t body = 0; body < still; ++body) {
    const std::int32_t lowest = islands_.lowest_of(body);
    std::uint8_t& kind = kinds_[std::size_t(body)];
    kind = lowest < body ? kinds_[std::size_t(lowest)] : std::uint8_t(kind_of_island(body));
    any = any || kind != kHeap;
  }
  if (!any) {
    kinds_.clear();
    return false;
  }
  for (std::vector<std::int32_t>& group : groups_) group.clear();
  // Of two bodies one may stay, which has no island.
  for (std::size_t i = 0; i < order.size(); ++i)
    groups_[std::min(kinds_[std::size_t(ends_[i].a)], kinds_[std::size_t(ends_[i].b)])].push_back(order[i]);
  return true;
}

}  // namespace rubble
