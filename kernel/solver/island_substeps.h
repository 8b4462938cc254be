// Which islands are solved apart, in more substeps than others.
//
// One sweep a substep carries a load a few pieces up or down, so what stands high on few contacts gives way like a soft
// spring: a column of twenty bricks leans by itself, heaps of sheets shake and creep by centimetres. Such islands have few
// contacts, so more substeps cost little. Heaps have many for their height, and gain nothing by them.
// Not for use outside kernel/.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/collision/body.h"
#include "kernel/collision/contact.h"
#include "kernel/solver/islands.h"

namespace rubble {

// Islands at least `height` pieces high with at most `contacts` a piece of their height have so many substeps for one of
// a heap. The first that fits counts. unit: 1
struct IslandKind {
  int substeps, height, contacts;
};
inline constexpr IslandKind kIslandKinds[] = {{8, 7, 100}, {2, 7, 150}};
inline constexpr int kIslandKindCount = sizeof kIslandKinds / sizeof kIslandKinds[0];

class IslandSubsteps {
 public:
  static constexpr int kHeap = kIslandKindCount;  // the kind of all others

  // order: of contacts, bottom up. Islands with links of trees, or with ties, which have numbers from `ties` on, are heaps.
  // Returns whether any is not.
  bool split(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
             const std::vector<std::int32_t>& order, ThreadPool& pool);
  // Those of a kind in the last split(), in its order.
  const std::vector<std::int32_t>& contacts(int kind) const { return groups_[kind]; }
  int kind_of(std::int32_t body) const { return kinds_.empty() ? kHeap : kinds_[std::size_t(body)]; }

 private:
  // Bodies of a contact, numbered as Islands does. tied: it is of a tie or of a link of a tree.
  struct Ends {
    std::int32_t a, b;
    bool tied;
  };

  void note_ends(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                 const std::vector<std::int32_t>& order, ThreadPool& pool);
  int kind_of_island(std::int32_t lowest) const;

  Islands islands_;
  std::vector<Ends> ends_;           // in order
  std::vector<std::uint8_t> tied_;   // with a link of a tree or a tie; by the lowest body of an island
  std::vector<std::uint8_t> kinds_;  // by body, and of what stays; none where all are heaps
  std::vector<std::int32_t> groups_[kIslandKindCount + 1];
};

}  // namespace rubble
