// Loops that threads share.
#include "kernel/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace rubble {
namespace parallel_test {

TEST(ThreadPool, MeetsEveryIndexOnceInEveryRound) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    std::vector<int> met(257);
    for (int round = 1; round <= 3000; ++round) {
      const int count = 1 + round % int(met.size()), grain = 1 + round % 7;
      pool.run(count, grain, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) ++met[std::size_t(i)];
      });
      for (int i = 0; i < count; ++i) ASSERT_EQ(met[std::size_t(i)], 1) << threads << " threads, round " << round;
      std::fill(met.begin(), met.end(), 0);
    }
    pool.run(0, 1, [](int, int) { FAIL(); });
  }
}

// Each waits for all others: on fewer threads it would never end.
TEST(ThreadPool, RunsTogetherWhatWaitsForEachOther) {
  ThreadPool pool(3);
  for (int round = 0; round < 300; ++round) {
    std::atomic<int> here{0};
    std::set<std::thread::id> ids[3];
    pool.run_together(3, [&](int i) {
      ids[i].insert(std::this_thread::get_id());
      for (++here; here < 3;) std::this_thread::yield();
    });
    EXPECT_EQ(here, 3);
    EXPECT_NE(*ids[0].begin(), *ids[1].begin());
    EXPECT_NE(*ids[1].begin(), *ids[2].begin());
  }
}

// The caller works alone for a while, and what waits for each other is still run together.
TEST(ThreadPool, WorksAloneWhereItIsCrowded) {
  ThreadPool pool(2);
  EXPECT_FALSE(pool.crowded());
  pool.note_crowded();
  std::set<std::thread::id> ids;
  std::mutex mutex;
  pool.run(100, 1, [&](int, int) {
    const std::lock_guard<std::mutex> lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  if (pool.crowded()) {  // this thread was not kept away for longer
    EXPECT_EQ(ids, std::set<std::thread::id>{std::this_thread::get_id()});
  }
  std::atomic<int> here{0};
  pool.run_together(2, [&](int) {
    for (++here; here < 2;) std::this_thread::yield();
  });
  EXPECT_EQ(here, 2);
  while (pool.crowded()) std::this_thread::yield();  // ends by itself

  ThreadPool alone(1);
  alone.note_crowded();
  EXPECT_FALSE(alone.crowded()) << "there is nobody to wait for";
}

}  // namespace parallel_test
}  // namespace rubble
