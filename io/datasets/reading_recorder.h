// Readings of sensors as tables: sensors/NAME.csv, stamps in nanoseconds, then the columns of its kind with their units.
#pragma once

#include <memory>
#include <string>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_reading_recorder(const std::string& path, const Recording& recording);

}  // namespace rubble
