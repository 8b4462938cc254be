// MCAP files (mcap.dev/spec), as ROS 2 records since Iron, without ROS.
//
// Topics of one type share its schema. Messages are gathered into chunks, each compressed by zstd on one of several threads and written
// in order. The file ends in a summary (schemas, channels, chunk index, statistics), so that
// readers find any time at once. Every checksum of the format is filled in. Nothing of the machine
// or the clock is in the file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/base/atomic_file.h"
#include "io/base/ordered_tasks.h"

namespace rubble {

enum class McapCompression { none, zstd };

struct McapTopic {
  std::string topic;   // e.g. "/clock"
  std::string type;    // e.g. "rosgraph_msgs/msg/Clock"
  std::string schema;  // of the type and of all types in it, as ros2msg
  std::string qos;     // offered_qos_profiles of rosbag2, YAML
};

// What an index of the file says of it: metadata.yaml of rosbag2.
struct McapSummary {
  std::vector<McapTopic> topics;           // in the order of their channels
  std::vector<std::uint32_t> counts;       // messages of each
  std::int64_t first_ns = 0, last_ns = 0;  // stamps of the first and the last message; both 0: there is none
};

class McapWriter {
 public:
  McapWriter(const std::string& path, McapCompression compression, int threads);

  // All channels come before the first message. Returns its number.
  std::uint16_t add_channel(const McapTopic& topic);
  // stamp_ns: >= 0; throws RunError otherwise. `sequence` counts the messages of a channel.
  void write(std::uint16_t channel, std::int64_t stamp_ns, std::string_view message);
  void finish();
  McapSummary summary() const;  // of all that was written

 private:
  struct IndexEntry {
    std::uint64_t time, offset;
  };
  struct Chunk {  // one being filled or compressed
    std::string records;
    std::vector<std::vector<IndexEntry>> index;  // per channel
    std::uint64_t first_time = 0, last_time = 0;
  };
  struct ChunkInfo {  // of one that is written
    std::uint64_t first_time, last_time, position, length;
    std::vector<std::uint64_t> index_positions;  // per channel; 0: none
    std::uint64_t index_length, compressed_size, size;
  };

  void write_bytes(std::string_view bytes);
  void close_chunk();
  void write_chunk(const Chunk& chunk, const std::string& bytes, std::uint32_t crc,
                   std::uint64_t compressed_size);
  std::uint16_t schema_of(const McapTopic& topic) const;
  std::string schemas() const;
  std::string channels() const;
  std::string chunk_indexes() const;
  std::string statistics() const;

  AtomicFile file_;
  std::uint32_t crc_ = 0;  // of all bytes written so far
  McapCompression compression_;
  std::vector<McapTopic> topics_;
  std::vector<McapTopic> types_;       // the first topic of each type: its schema is that of the others
  std::vector<std::uint32_t> counts_;  // messages per channel
  std::vector<ChunkInfo> chunks_;
  bool announced_ = false;  // schemas and channels stand in front of the first chunk
  std::uint64_t first_time_ = 0, last_time_ = 0;  // of all messages
  Chunk chunk_;             // the open one
  OrderedTasks tasks_;      // last, so that it goes first: its tasks refer to the others
};

}  // namespace rubble
