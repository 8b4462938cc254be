// Loops that threads share.
#include "kernel/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
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

// The caller waits until the others have come: each has an index and a thread of its own.
TEST(ThreadPool, HelpersComeOnceEach) {
  ThreadPool pool(3);
  for (int round = 0; round < 300; ++round) {
    std::atomic<int> here{0};
    std::set<std::thread::id> ids[3];
    pool.run_with_help(3, [&](int i) {
      ids[i].insert(std::this_thread::get_id());
      for (++here; i == 0 && here < 3 && !pool.crowded();) std::this_thread::yield();
    });
    ASSERT_EQ(*ids[0].begin(), std::this_thread::get_id());
    if (here < 3) continue;  // the machine is busy
    EXPECT_EQ(here, 3);
    EXPECT_NE(*ids[0].begin(), *ids[1].begin());
    EXPECT_NE(*ids[1].begin(), *ids[2].begin());
  }
}

// A caller that does all alone in no time does not wait for threads that have not come.
TEST(ThreadPool, NobodyWaitsForHelpersThatDoNotCome) {
  ThreadPool pool(2);
  for (int round = 0; round < 3000; ++round) {
    std::atomic<int> left{1}, inside{0};
    pool.run_with_help(2, [&](int i) {
      ++inside;
      if (i == 0) left = 0;
      --inside;
    });
    ASSERT_EQ(left, 0);
    ASSERT_EQ(inside, 0) << "body may be gone";
  }
}

// Asleep nobody is preempted: a thread that spins on a busy machine would keep the pool crowded for ever.
void sleep_while_crowded(ThreadPool& pool) {
  while (pool.crowded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// A thread of the program itself may take a processor for a moment.
TEST(ThreadPool, BearsAShortWait) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  ThreadPool pool(2);
  bool crowded = pool.crowded();
  for (int k = 0; k < 4; ++k) {
    pool.note_wait(0.005);
    crowded = crowded || pool.crowded();
  }
  const bool at_once = Clock::now() - begin < std::chrono::milliseconds(20);  // else others may have taken the processor
  if (at_once) {
    EXPECT_FALSE(crowded);
  }
  sleep_while_crowded(pool);
  pool.note_wait(0.1);
  pool.note_wait(0.1);
  EXPECT_TRUE(pool.crowded() || Clock::now() - begin > std::chrono::milliseconds(40));
}

// The caller works alone for a while, longer when that happens again at once.
TEST(ThreadPool, WorksAloneWhereItIsCrowded) {
  ThreadPool pool(2);
  EXPECT_FALSE(pool.crowded());
  pool.note_wait(1);
  std::set<std::thread::id> ids;
  std::mutex mutex;
  pool.run(100, 1, [&](int, int) {
    const std::lock_guard<std::mutex> lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  if (pool.crowded()) {  // this thread was not kept away for longer
    EXPECT_EQ(ids, std::set<std::thread::id>{std::this_thread::get_id()});
  }
  pool.run_with_help(2, [&](int i) { EXPECT_TRUE(i == 0 || !pool.crowded()); });
  using Clock = std::chrono::steady_clock;
  double least = 0.05;  // unit: s
  for (int k = 0; k < 3; ++k) {
    sleep_while_crowded(pool);
    const Clock::time_point begin = Clock::now();
    pool.note_wait(1);
    const bool at_once = Clock::now() - begin < std::chrono::milliseconds(1);
    sleep_while_crowded(pool);
    const double alone = std::chrono::duration<double>(Clock::now() - begin).count();
    if (at_once) {
      EXPECT_GE(alone, least);
    }
    least = at_once ? 2 * least : 0.1;
  }

  ThreadPool alone(1);
  alone.note_wait(1);
  EXPECT_FALSE(alone.crowded()) << "there is nobody to wait for";
}

}  // namespace parallel_test
}  // namespace rubble
