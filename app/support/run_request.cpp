#include "app/support/run_request.h"

#include <algorithm>

#include "kernel/base/system/thread_count.h"

namespace rubble {

RunContext::RunContext(const RunOptions& asked)
    : options(asked), progress(choose_progress_style(asked.quiet)) {
  threads();  // a mistake in RUBBLE_THREADS is told before anything begins
}

int RunContext::threads() const {
  if (options.threads > 0) return options.threads;
  return default_thread_count();
}

}  // namespace rubble
