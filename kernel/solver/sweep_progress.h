// Progress of each thread in the sweeps of a step. Not for use outside kernel/.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

namespace rubble {

class SweepProgress {
 public:
  explicit SweepProgress(int threads) : threads_(threads), at_(new Counter[std::size_t(threads)]) {}

  // Everything before `point` is done. Points of one thread never fall.
  void reach(int thread, std::int64_t point) {
    at_[thread].value.store(point, std::memory_order_release);
  }
  // Returns when the other thread has reached the point.
  void wait_for(int thread, std::int64_t point) {
    const int patience = crowded() ? kFewSpins : kSpins;
    int tries = 0;
    while (at_[thread].value.load(std::memory_order_acquire) < point) {
      if (++tries < patience) {
#if defined(__x86_64__)
        __builtin_ia32_pause();
#endif
        continue;
      }
      // It does not run: another program has its processor, or needs this one.
      crowded_.store(true, std::memory_order_relaxed);
      std::this_thread::yield();
    }
  }
  void meet(int thread, std::int64_t point) {
    reach(thread, point);
    for (int other = 0; other < threads_; ++other) wait_for(other, point);
  }
  // Whether somebody waited in vain for a thread that did not run.
  bool crowded() const { return crowded_.load(std::memory_order_relaxed); }

 private:
  // Tries before a thread yields: a few tenths of a millisecond, longer than it takes to wake a thread.
  static constexpr int kSpins = 20000;
  // The same after another program was found to use the processor.
  static constexpr int kFewSpins = 100;
  struct alignas(64) Counter {
    std::atomic<std::int64_t> value{-1};
  };

  int threads_;
  std::unique_ptr<Counter[]> at_;
  std::atomic<bool> crowded_{false};
};

}  // namespace rubble
