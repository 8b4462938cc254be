// When messages go out: simulation time tied to the wall's clock.
#pragma once

#include <chrono>
#include <cstdint>

#include "io/live/live_ros.h"

namespace rubble {

class Pace {
 public:
  explicit Pace(const LiveOptions& options) : options_(options) {}

  // Until every topic has a subscriber, as `ready` says, or options.wait is over.
  void wait_for(const std::function<bool()>& ready) const;
  // Until the message of that stamp is due. What comes late is due at once, and what follows is
  // counted from there: time never runs faster than asked, to catch up.
  void wait_until(std::int64_t stamp_ns);

 private:
  using Clock = std::chrono::steady_clock;

  // Returns early when the run is to stop.
  void sleep_until(Clock::time_point due) const;

  LiveOptions options_;
  bool started_ = false;
  std::int64_t first_ns_ = 0;
  Clock::time_point start_;  // when first_ns_ was due
};

}  // namespace rubble
