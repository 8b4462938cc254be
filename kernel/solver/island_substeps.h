// Which islands are solved apart, in more substeps than others.
//
// One sweep a substep carries a load a few pieces up or down, so what stands high on few contacts gives way like a soft
// spring: a column of twenty bricks leans by itself, heaps of sheets shake and creep by centimetres. Such islands have few
// contacts, so more substeps cost little. Heaps have many for their height, and gain nothing by them. What hangs on bars moves
// loads far, too: ruins whose bars yield a little in every step would come down in a minute.
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
// a heap. The first that fits counts. The last kind is that of islands with ties. unit: 1
struct IslandKind {
  int substeps, height, contacts;
};
inline constexpr IslandKind kIslandKinds[] = {{8, 7, 100}, {2, 7, 150}, {4, 0, 0}};
inline constexpr int kIslandKindCount = sizeof kIslandKinds / sizeof kIslandKinds[0];

class IslandSubsteps {
 public:
  static constexpr int kTied = kIslandKindCount - 1;
  static constexpr int kHeap = kIslandKindCount;  // the kind of all others

  // order: of contacts, bottom up. Ties have numbers from `ties` on. Islands with links of trees are heaps.
  // Returns whether any is not.
  bool split(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
             const std::vector<std::int32_t>& order, ThreadPool& pool);
  // Those of a kind in the last split(), in its order.
  const std::vector<std::int32_t>& contacts(int kind) const { return groups_[kind]; }
  int kind_of(std::int32_t body) const { return kinds_.empty() ? kHeap : kinds_[std::size_t(body)]; }

 private:
  // What holds an island together besides contact.
  enum Bond : std::uint8_t { kNone = 0, kTie = 1, kLink = 2 };
  // Bodies of a contact, numbered as Islands does. bonds: what it is, and its bodies are, a sum of Bond.
  struct Ends {
    std::int32_t a, b;
    std::uint8_t bonds;
  };

  void note_ends(const std::vector<Body>& bodies, const std::vector<Contact>& contacts, std::size_t ties,
                 const std::vector<std::int32_t>& order, ThreadPool& pool);
  int kind_of_island(std::int32_t lowest) const;

  Islands islands_;
  std::vector<Ends> ends_;           // in order
  std::vector<std::uint8_t> bonds_;  // by the lowest body of an island
  std::vector<std::uint8_t> kinds_;  // by body, and of what stays; none where all are heaps
  std::vector<std::int32_t> groups_[kIslandKindCount + 1];
};

}  // namespace rubble
