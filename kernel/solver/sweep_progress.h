// Progress of each domain in the sweeps of a step, and who is at it. Not for use outside kernel/.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>

namespace rubble {

class SweepProgress {
 public:
  explicit SweepProgress(int domains) : domains_(domains), at_(new Counter[std::size_t(domains)]) {}

  // Everything before `point` is done. Points of one domain never fall.
  void reach(int domain, std::int64_t point) {
    at_[domain].value.store(point, std::memory_order_release);
  }
  bool reached(int domain, std::int64_t point) const {
    return at_[domain].value.load(std::memory_order_acquire) >= point;
  }
  bool all_reached(std::int64_t point) const {
    for (int domain = 0; domain < domains_; ++domain)
      if (!reached(domain, point)) return false;
    return true;
  }
  // Whoever takes a domain sees all that was done in it, and goes on alone there until giving it back. False: another
  // thread has it.
  bool take(int domain) {
    Counter& counter = at_[domain];
    return !counter.taken.load(std::memory_order_relaxed) && !counter.taken.exchange(true, std::memory_order_acquire);
  }
  void give_back(int domain) { at_[domain].taken.store(false, std::memory_order_release); }

 private:
  struct alignas(64) Counter {
    std::atomic<std::int64_t> value{-1};
    std::atomic<bool> taken{false};
  };

  int domains_;
  std::unique_ptr<Counter[]> at_;
};

// A thread that finds nothing to do: it looks again and again. After a while the caller sleeps in between, and the others
// leave it alone: another program may have the processor of one of them, which takes a time slice.
class IdleWait {
 public:
  explicit IdleWait(bool is_caller) : is_caller_(is_caller) {}

  // Before the next look. False: leave.
  bool pause() {
    ++tries_;
    if (tries_ > (is_caller_ ? kSpins : kMostSpins)) {
      if (!is_caller_) return false;
      nap();
    }
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
    return true;
  }
  void reset() { tries_ = 0; }
  bool at_length() const { return tries_ > kShort; }
  // How long it waited where it took so long that somebody cannot have run. unit: s
  double in_vain() const { return in_vain_; }

 private:
  using Clock = std::chrono::steady_clock;
  // Looks after which it helps others: more than the plan makes a thread wait.
  static constexpr int kShort = 20;
  // Looks of the caller without sleep: a tenth of a millisecond.
  static constexpr int kSpins = 2000;
  // Looks of others until they leave: longer than it takes to wake a thread.
  static constexpr int kMostSpins = 10000;
  // Sleep of the caller between looks, short beside a time slice. unit: us
  static constexpr int kNap = 50;
  // Nobody who runs takes so long for a batch; a time slice of Linux has 3 ms and more. unit: us
  static constexpr int kLongest = 1000;

  void nap() {
    if (tries_ == kSpins + 1) begin_ = Clock::now();
    std::this_thread::sleep_for(std::chrono::microseconds(kNap));
    const Clock::time_point now = Clock::now();
    if (now - begin_ < std::chrono::microseconds(kLongest)) return;
    in_vain_ += std::chrono::duration<double>(now - std::exchange(begin_, now)).count();
  }

  bool is_caller_;
  int tries_ = 0;
  double in_vain_ = 0;  // unit: s
  Clock::time_point begin_{};
};

}  // namespace rubble
