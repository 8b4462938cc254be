#include "io/base/ordered_tasks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace rubble {
namespace ordered_tasks_test {

class OrderedTasksTest : public ::testing::TestWithParam<int> {};

// Later tasks are the quicker ones, so that they would overtake.
TEST_P(OrderedTasksTest, CommitsInOrderOnTheCallersThread) {
  OrderedTasks tasks(GetParam());
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<int> committed;
  for (int i = 0; i < 40; ++i) {
    tasks.add([&, i]() -> OrderedTasks::Commit {
      std::this_thread::sleep_for(std::chrono::microseconds(300 - 7 * i));
      return [&, i] {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        committed.push_back(i);
      };
    });
  }
  tasks.finish();
  ASSERT_EQ(committed.size(), 40u);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(committed[static_cast<std::size_t>(i)], i);
}

TEST_P(OrderedTasksTest, ThrowsWhatATaskThrewAndCommitsNothingLater) {
  std::vector<int> committed;
  std::string thrown;
  try {
    OrderedTasks tasks(GetParam());
    for (int i = 0; i < 40; ++i) {
      tasks.add([&, i]() -> OrderedTasks::Commit {
        if (i == 5) throw std::runtime_error("the fifth");
        return [&, i] { committed.push_back(i); };
      });
    }
    tasks.finish();
  } catch (const std::runtime_error& error) {
    thrown = error.what();
  }
  EXPECT_EQ(thrown, "the fifth");
  EXPECT_EQ(committed, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST_P(OrderedTasksTest, CanBeLeftWithWorkUnderWay) {
  std::atomic<int> ran{0};
  {
    OrderedTasks tasks(GetParam());
    for (int i = 0; i < 3; ++i) tasks.add([&]() -> OrderedTasks::Commit { return ++ran, [] {}; });
  }
  EXPECT_LE(ran, 3);
}

INSTANTIATE_TEST_SUITE_P(Threads, OrderedTasksTest, ::testing::Values(1, 2, 4));

}  // namespace ordered_tasks_test
}  // namespace rubble
