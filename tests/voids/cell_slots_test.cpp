// Numbers, kinds and runs of cells of a grid against plain lists.
#include "kernel/voids/cell_slots.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernel/base/random.h"
#include "kernel/voids/cell_kinds.h"
#include "kernel/voids/cell_runs.h"

namespace rubble {
namespace cell_slots_test {

TEST(CellSlots, NumberTheWantedCellsInTheirOrder) {
  RandomStream random(1, "slots");
  for (const std::size_t cells : {1, 63, 64, 65, 1000, 64 * 64, 64 * 64 + 1, 50000}) {
    std::vector<char> wanted;
    std::vector<std::uint32_t> list;
    bool here = true;  // in large grids not all words, and not all groups of words, have a wanted cell
    for (std::size_t i = 0; i < cells; ++i) {
      if (i % 500 == 0) here = cells <= 1000 || random.below(6) == 0;
      wanted.push_back(char(here && random.below(3) == 0));
      if (wanted.back()) list.insert(list.begin() + std::ptrdiff_t(random.below(list.size() + 1)), std::uint32_t(i));
    }
    const CellSlots by_rule(cells, [&](std::size_t i) { return wanted[i] != 0; }), by_list(cells, list);
    EXPECT_EQ(by_rule.count(), list.size());
    EXPECT_EQ(by_list.count(), list.size());
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      const std::uint32_t expected = wanted[i] ? before++ : kNoSlot;
      ASSERT_EQ(by_rule[i], expected) << i << " of " << cells;
      ASSERT_EQ(by_list[i], expected) << i << " of " << cells;
    }
  }
}

TEST(CellKinds, AreThoseThatWereSetLast) {
  RandomStream random(2, "kinds");
  for (const std::size_t cells : {1, 31, 32, 33, 1000}) {
    CellKinds kinds(cells);
    std::vector<CellKind> list(cells, CellKind::free_void);
    for (std::size_t n = 0; n < 3 * cells; ++n) {
      const std::size_t i = random.below(cells);
      list[i] = CellKind(random.below(3));
      kinds.set(i, list[i]);
    }
    for (const std::size_t left : {cells, cells / 2}) {
      kinds.shrink(left), list.resize(left);
      ASSERT_EQ(kinds.size(), left);
      for (std::size_t i = 0; i < left; ++i) ASSERT_EQ(kinds[i], list[i]) << i << " of " << left;
      for (const CellKind kind : {CellKind::outside, CellKind::free_void, CellKind::solid})
        EXPECT_EQ(kinds.count(kind), std::size_t(std::count(list.begin(), list.end(), kind))) << left;
    }
  }
}

TEST(CellRuns, AreTheCellsInTheirOrder) {
  const CellRuns runs({{40, 2}, {7, 1}, {8, 3}, {20, 1}});
  const std::vector<std::uint32_t> cells{7, 8, 9, 10, 20, 40, 41};
  EXPECT_EQ(std::vector<std::uint32_t>(runs.begin(), runs.end()), cells);
  EXPECT_EQ(runs.size(), 7u);
  EXPECT_EQ(runs.runs().size(), 3u) << "7 and 8 are beside each other";
  EXPECT_EQ(runs[3], 10u);
  EXPECT_EQ(runs[5], 40u);
  EXPECT_TRUE(CellRuns().empty());
  EXPECT_TRUE(CellRuns().begin() == CellRuns().end());
}

}  // namespace cell_slots_test
}  // namespace rubble
