// Work that threads share: a pool for loops that come again and again, and one-off loops.
//
// Every iteration writes to its own slots only, so results do not depend on the thread count or on
// which thread takes which part.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace rubble {

class ThreadPool {
 public:
  // 0: as many as the machine has processors. 1: everything runs in the caller.
  explicit ThreadPool(int threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;
  // Of the caller. Whether others took a processor from it, or from threads that it waited for, for a good share of the time.
  // Then loops run in the caller alone for a while: waiting for a thread that does not run costs more than doing its work.
  bool crowded();
  // The caller waited so long for a thread that did not run. Where such waits take a good share of the time, loops run in the
  // caller alone for a while, and longer if this happens soon again. unit: s
  void note_wait(double time);
  // Calls body(begin, end) for consecutive ranges of `grain` that cover [0, count), the last perhaps shorter, or once for all of
  // it, and returns when all are done. `body` must not throw. A thread that has not begun when nothing is left is not waited for.
  void run(int count, int grain, const std::function<void(int, int)>& body);
  // Calls body(0) in the caller, and meanwhile body(i), each 0 < i < count at most once, on threads that come in time. So the
  // caller must be able to do all alone. Who has not come when body(0) returns is not waited for.
  void run_with_help(int count, const std::function<void(int)>& body);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

// Calls job(i) once for each i in [0, count), on `threads` threads of its own (at least one): for
// long jobs, which may throw. The first exception in order of index is thrown again.
template <typename Job>
void parallel_for(std::size_t count, int threads, const Job& job) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(count);
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        job(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> helpers;
  for (int t = 1; t < threads && std::size_t(t) < count; ++t) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace rubble
