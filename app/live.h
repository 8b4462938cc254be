// Publishing while frames are drawn, as asked for on the command line.
#pragma once

#include "app/recorders.h"
#include "app/run_request.h"

namespace rubble {

// Before anything is settled or drawn: InputError or RunError when it cannot be.
void check_live(const RunOptions& options);
// Adds a publisher to the recorders of files. After check_live(), with the same options.
void add_live_recorders(RecorderSet& set, const RunOptions& options, const RosOptions& ros);

}  // namespace rubble
