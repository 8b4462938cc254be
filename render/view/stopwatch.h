// Takes the time of a pass. Internal to render/.
#pragma once

#include <time.h>

#include <chrono>

#include "render/view/render_options.h"

namespace rubble {

// Runs from its construction.
class Stopwatch {
 public:
  PassTime time() const {
    return {std::chrono::duration<double, std::milli>(Clock::now() - start_).count(),
            (processor_seconds() - start_processor_) * 1e3};
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
  }
  Clock::time_point start_ = Clock::now();
  double start_processor_ = processor_seconds();
};

}  // namespace rubble
