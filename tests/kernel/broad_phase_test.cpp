#include "kernel/collision/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/base/random.h"

namespace rubble {
namespace broad_phase_test {

// Boxes from 5 cm to 200 m, most of them small; some so long that no grid holds them.
Aabb draw_box(RandomStream& random) {
  const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const double size = std::pow(10, draw(-1.3, random.uniform() < 0.3 ? 2.3 : 0));
  const Vec3 place{draw(-60, 60), draw(-60, 60), draw(0, 20)};
  const Vec3 half{size * draw(0.1, 1), size * draw(0.1, 1), random.uniform() < 0.02 ? 1e5 : size * draw(0.1, 1)};
  return {place - half, place + half};
}

// In their order, and each once.
TEST(BroadPhase, FindsWhatASearchThroughAllBoxesFinds) {
  for (const int count : {40, 1500}) {  // few large ones are looked through, many lie in grids
    RandomStream random(7, "broad phase");
    BroadPhase broad;
    std::vector<bool> there(std::size_t(count), true);
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(broad.add(), i);
      broad.place(i, draw_box(random));
    }
    for (int round = 0; round < 3; ++round) {
      for (int i = 0; i < count; ++i) {
        if (!there[std::size_t(i)]) continue;
        std::vector<std::int32_t> found, expected;
        broad.find(i, found);
        for (int other = 0; other < count; ++other)
          if (other != i && there[std::size_t(other)] && BroadPhase::overlap(broad.box(i), broad.box(other))) expected.push_back(other);
        ASSERT_EQ(found, expected) << i << " of " << count << ", round " << round;
      }
      // A fifth goes elsewhere, some go away.
      for (int k = 0; k < count / 5; ++k) {
        const int item = int(random.uniform() * count);
        if (!there[std::size_t(item)]) continue;
        there[std::size_t(item)] = random.uniform() < 0.8;
        if (there[std::size_t(item)]) {
          broad.place(item, BroadPhase::enlarge(draw_box(random), {0, 0, -1}));
        } else {
          broad.remove(item);
        }
      }
    }
  }
}

}  // namespace broad_phase_test
}  // namespace rubble
