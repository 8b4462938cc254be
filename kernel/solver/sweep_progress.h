// Progress of each thread in the sweeps of a step. Not for use outside kernel/.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace rubble {

class SweepProgress {
 public:
  explicit SweepProgress(int threads) : threads_(threads), at_(new Counter[std::size_t(threads)]) {}

  // Everything before `point` is done. Points of one thread never fall.
  void reach(int thread, std::int64_t point) {
    at_[thread].value.store(point, std::memory_order_release);
  }
  bool reached(int thread, std::int64_t point) const {
    return at_[thread].value.load(std::memory_order_acquire) >= point;
  }
  bool all_reached(std::int64_t point) const {
    for (int thread = 0; thread < threads_; ++thread)
      if (!reached(thread, point)) return false;
    return true;
  }
  // Tries until it succeeds. False: in vain, as somebody does not run: another program has its processor.
  template <typename Try>
  bool wait_until(const Try& attempt) {
    for (int tries = 0; !attempt(); ++tries) {
      if (tries == kSpins || (tries % kLook == 0 && crowded())) {
        crowded_.store(true, std::memory_order_relaxed);
        return false;
      }
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
    return true;
  }
  // Whether somebody waited in vain.
  bool crowded() const { return crowded_.load(std::memory_order_relaxed); }

 private:
  // Tries before a thread gives up: a few tenths of a millisecond, longer than it takes to wake a thread.
  static constexpr int kSpins = 20000;
  static constexpr int kLook = 100;  // tries between looks at what others found
  struct alignas(64) Counter {
    std::atomic<std::int64_t> value{-1};
  };

  int threads_;
  std::unique_ptr<Counter[]> at_;
  std::atomic<bool> crowded_{false};
};

}  // namespace rubble
