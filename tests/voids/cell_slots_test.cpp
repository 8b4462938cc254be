// Numbers of some cells of a grid against counting them.
#include "kernel/voids/cell_slots.h"

#include <gtest/gtest.h>

#include "kernel/base/random.h"

namespace rubble {
namespace cell_slots_test {

TEST(CellSlots, NumberTheWantedCellsInTheirOrder) {
  RandomStream random(1, "slots");
  for (const std::size_t cells : {1, 63, 64, 65, 1000}) {
    std::vector<char> wanted;
    std::vector<std::uint32_t> list;
    for (std::size_t i = 0; i < cells; ++i) {
      wanted.push_back(char(random.below(3) == 0));
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

}  // namespace cell_slots_test
}  // namespace rubble
