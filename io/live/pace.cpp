#include "io/live/pace.h"

#include <algorithm>
#include <thread>

namespace rubble {
namespace {

constexpr std::chrono::milliseconds kPaceNap{20};  // how soon a stop is noticed

}  // namespace

void Pace::wait_for(const std::function<bool()>& ready) const {
  const auto end = Clock::now() + std::chrono::duration<double>(options_.wait);
  while (Clock::now() < end && !options_.stopped() && !ready()) std::this_thread::sleep_for(kPaceNap);
}

void Pace::wait_until(std::int64_t stamp_ns) {
  if (options_.rate <= 0) return;
  if (!started_) {
    started_ = true;
    first_ns_ = stamp_ns;
    start_ = Clock::now();
  }
  const std::chrono::duration<double> after_first(double(stamp_ns - first_ns_) * 1e-9 / options_.rate);
  const auto due = start_ + std::chrono::duration_cast<Clock::duration>(after_first);
  sleep_until(due);
  start_ += std::max(Clock::duration::zero(), Clock::now() - due);
}

void Pace::sleep_until(Clock::time_point due) const {
  while (Clock::now() < due && !options_.stopped())
    std::this_thread::sleep_until(std::min(due, Clock::now() + kPaceNap));
}

}  // namespace rubble
