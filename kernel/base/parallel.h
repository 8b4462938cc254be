// A few worker threads for loops whose iterations are independent of each other.
//
// Every iteration writes to its own slots only, so results do not depend on the thread count or on
// which thread takes which part.
#pragma once

#include <functional>
#include <memory>

namespace rubble {

class ThreadPool {
 public:
  // 0: as many as the machine has processors. 1: everything runs in the caller.
  explicit ThreadPool(int threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;
  // Calls body(begin, end) for consecutive ranges of at most `grain` that cover [0, count), and
  // returns when all are done. `body` must not throw.
  void run(int count, int grain, const std::function<void(int, int)>& body);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace rubble
