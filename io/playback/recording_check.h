// Is a recording whole? What can be told from the file alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "io/base/file_cursor.h"

namespace rubble {

struct RecordingCheck {
  std::string kind;                              // "ROS 1 bag", "MCAP", "gzip"
  std::map<std::string, std::int64_t> messages;  // by topic, before the fault if there is one
  std::optional<FileFault> fault;                // the first one
};

// Bags, MCAP files, and what is gzipped: rawlogs and simplemaps. By the file's first bytes, or,
// when those are damaged, its name. Nothing: of another kind. Throws InputError when the file
// cannot be read.
std::optional<RecordingCheck> check_recording(const std::string& path);

// The fault alone; nothing for files of other kinds, too.
std::optional<FileFault> find_fault(const std::string& path);

}  // namespace rubble
