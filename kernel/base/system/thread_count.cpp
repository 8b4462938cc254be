#include "kernel/base/system/thread_count.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "kernel/base/error.h"

namespace rubble {
namespace {

// Processors that a quota of Linux' control groups (version 2, then 1) leaves this process; 0: no quota is seen.
double quota_of_processors() {
  std::string quota;
  double period = 0;
  if (std::ifstream("/sys/fs/cgroup/cpu.max") >> quota >> period)
    return quota == "max" || period <= 0 ? 0 : std::strtod(quota.c_str(), nullptr) / period;
  double microseconds = 0;
  if (std::ifstream("/sys/fs/cgroup/cpu/cpu.cfs_quota_us") >> microseconds && microseconds > 0 &&
      std::ifstream("/sys/fs/cgroup/cpu/cpu.cfs_period_us") >> period && period > 0)
    return microseconds / period;
  return 0;
}

}  // namespace

int default_thread_count() {
  if (const char* asked = std::getenv("RUBBLE_THREADS")) {
    char* end = nullptr;
    const long count = std::strtol(asked, &end, 10);
    if (end != asked && *end == '\0' && count >= 1 && count <= 1024) return int(count);
    throw InputError({"the environment", 0, "RUBBLE_THREADS", "wrong value", "a whole number from 1 to 1024", asked,
                      "unset it for the number of processors"});
  }
  // Where affinity is set, the standard library of Linux counts only the processors that it leaves.
  const int processors = std::max(1, int(std::thread::hardware_concurrency()));
  const double quota = quota_of_processors();
  return quota > 0 ? std::clamp(int(std::ceil(quota - 0.01)), 1, processors) : processors;
}

}  // namespace rubble
