// ROS 1 bag files, format 2.0, without ROS.
//
// The format is small and public (wiki.ros.org/Bags/Format/2.0). A writer of our own has every
// error in hand (the library's file class can end the program on a full disk), needs no ROS
// headers, and keeps nothing of the machine or the clock in the file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/base/atomic_file.h"

namespace rubble {

enum class BagCompression { none, lz4 };

struct BagTopic {
  std::string topic;       // e.g. "/clock"
  std::string type;        // e.g. "rosgraph_msgs/Clock"
  std::string md5;         // of the type, as rosmsg computes it
  std::string definition;  // of the type and of all types in it
  bool latching = false;   // a late subscriber gets the last message
};

class BagWriter {
 public:
  BagWriter(const std::string& path, BagCompression compression);

  // All connections come before the first message. Returns its number.
  std::uint32_t add_connection(const BagTopic& topic);
  // stamp_ns: > 0 (ROS takes 0 for "no time"), seconds below 2^32; throws RunError otherwise.
  void write(std::uint32_t connection, std::int64_t stamp_ns, std::string_view message);
  void finish();

 private:
  struct IndexEntry {
    std::uint64_t time;  // as ROS: seconds in the low half, nanoseconds in the high one
    std::uint32_t offset;
  };
  struct ChunkInfo {
    std::uint64_t position, first_time, last_time;
    std::vector<std::uint32_t> counts;  // per connection
  };

  std::string connection_record(std::uint32_t connection) const;
  void close_chunk();
  void write_chunk();
  void write_chunk_index();
  std::string file_header(std::uint64_t index_position) const;

  AtomicFile file_;
  BagCompression compression_;
  std::vector<BagTopic> topics_;
  std::vector<bool> announced_;                 // connections already in some chunk
  std::vector<std::vector<IndexEntry>> index_;  // per connection, of the open chunk
  std::vector<ChunkInfo> chunks_;
  std::string chunk_;  // the open chunk, uncompressed
};

}  // namespace rubble
