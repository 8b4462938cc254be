// Publishing while frames are drawn, as asked for on the command line.
#pragma once

#include <memory>

#include "app/pipeline/recorders.h"
#include "app/support/run_request.h"

namespace rubble {

class DriveStream;  // io/live/live_ros.h

// Before anything is settled or drawn: InputError or RunError when it cannot be.
void check_live(const RunOptions& options);
// Adds a publisher to the recorders of files. After check_live(), with the same options.
void add_live_recorders(RecorderSet& set, const RunOptions& options, const RosOptions& ros);

// Of a drive, as fast as it is driven; none where none is asked for. After check_live().
std::unique_ptr<DriveStream> make_drive_stream(const RunOptions& options);

}  // namespace rubble
