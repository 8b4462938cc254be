#include "app/support/run_context.h"

#include <algorithm>
#include <thread>

namespace rubble {

RunContext::RunContext(const RunOptions& asked)
    : options(asked), progress(choose_progress_style(asked.quiet)) {}

int RunContext::threads() const {
  if (options.threads > 0) return options.threads;
  return std::max(1, int(std::thread::hardware_concurrency()));
}

}  // namespace rubble
