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

std::vector<int> ask(BroadPhase& broad, int item) {
  std::vector<int> found;
  broad.query(item, [&](int other) { found.push_back(other); });
  return found;
}

TEST(BroadPhase, FindsWhatASearchThroughAllBoxesFinds) {
  for (const int count : {40, 1500}) {  // few large ones are looked through, many lie in grids
    RandomStream random(7, "broad phase");
    BroadPhase broad;
    std::vector<bool> there(std::size_t(count), true);
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(broad.add(), i);
      broad.update(i, draw_box(random), {});
    }
    for (int round = 0; round < 3; ++round) {
      for (int i = 0; i < count; ++i) {
        if (!there[std::size_t(i)]) continue;
        std::vector<int> found = ask(broad, i), expected;
        for (int other = 0; other < count; ++other)
          if (other != i && there[std::size_t(other)] && BroadPhase::overlap(broad.box(i), broad.box(other))) expected.push_back(other);
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected) << i << " of " << count << ", round " << round;
      }
      // A fifth goes elsewhere, some go away.
      for (int k = 0; k < count / 5; ++k) {
        const int item = int(random.uniform() * count);
        if (!there[std::size_t(item)]) continue;
        there[std::size_t(item)] = random.uniform() < 0.8;
        if (there[std::size_t(item)]) {
          broad.update(item, draw_box(random), {0, 0, -1});
        } else {
          broad.remove(item);
        }
      }
    }
  }
}

// The order of pairs depends on the order of the calls alone, so not on how large items are found.
TEST(BroadPhase, LargeItemsComeInTheOrderOfTheirListWhetherFewOrMany) {
  BroadPhase few, many;
  const Aabb large{{-5, -5, 0}, {5, 5, 5}}, small{{0, 0, 0}, {0.1, 0.1, 0.1}};
  for (int i = 0; i < 200; ++i) {
    const Vec3 shift{i < 20 ? 0.1 * i : 1000.0 * i, 0, 0};
    const Aabb box{large.min + shift, large.max + shift};
    many.add(), many.update(i, box, {});
    if (i < 20) few.add(), few.update(i, box, {});
  }
  // The last takes the place of what goes; then it comes again.
  many.remove(3), many.update(3, large, {});
  few.remove(3), few.update(3, large, {});
  const int probe = many.add(), same = few.add();
  many.update(probe, small, {}), few.update(same, small, {});
  std::vector<int> of_few = ask(few, same), of_many = ask(many, probe);
  ASSERT_EQ(of_few.size(), 20U);
  ASSERT_EQ(of_many.size(), 20U);
  // In both the twenty stand as they were added, but for the one that went: its place is that of the last.
  of_few.erase(std::find(of_few.begin(), of_few.end(), 19)), of_few.erase(std::find(of_few.begin(), of_few.end(), 3));
  of_many.erase(std::find(of_many.begin(), of_many.end(), 19)), of_many.erase(std::find(of_many.begin(), of_many.end(), 3));
  EXPECT_EQ(of_few, of_many);
  EXPECT_TRUE(std::is_sorted(of_many.begin(), of_many.end()));
  EXPECT_EQ(ask(many, probe).back(), 3);
}

}  // namespace broad_phase_test
}  // namespace rubble
