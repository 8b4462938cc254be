// Publishing while frames are drawn, as asked for on the command line.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "app/pipeline/recorders.h"
#include "app/support/run_request.h"

namespace rubble {

class DriveStream;  // io/live/live_ros.h
class LiveServer;

// Before anything is settled or drawn: InputError or RunError when it cannot be.
void check_live(const RunOptions& options);
// Adds a publisher to the recorders of files. After check_live(), with the same options.
void add_live_recorders(RecorderSet& set, const RunOptions& options, const RosOptions& ros);

// A recorder's view of a stream that outlives it: topics that are known stay, and its end is not the end of the stream.
std::unique_ptr<RosFile> keep_stream(RosFile& stream, std::map<std::string, std::uint32_t>& topics);

// Of a drive, as fast as it is driven; none where none is asked for. After check_live().
std::unique_ptr<DriveStream> make_drive_stream(const RunOptions& options);
// Of `rubble serve`, at the rate that is asked for. After check_live().
std::unique_ptr<LiveServer> make_live_server(const RunOptions& options);

}  // namespace rubble
