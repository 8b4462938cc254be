// How a run is done and who is told of it, as apart from what is run: none of it changes a result.
#pragma once

#include <string>
#include <vector>

#include "app/support/progress.h"
#include "app/support/run_request.h"

namespace rubble {

struct RunContext {
  explicit RunContext(const RunOptions& asked);

  const RunOptions options;           // as they were asked for
  Progress progress;                  // what a person sees meanwhile
  std::vector<std::string> warnings;  // what is likely not as it was meant, for a person

  int threads() const;  // as asked, or all processors; at least 1
};

}  // namespace rubble
