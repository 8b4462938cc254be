#include "io/ros/bag_writer.h"

#include <lz4frame.h>

#include <algorithm>
#include <limits>

#include "io/base/little_endian.h"
#include "io/ros/bag_format.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr std::size_t kBagChunkSize = 768 * 1024;  // unit: byte; that of rosbag
constexpr std::size_t kFileHeaderSize = 4096;        // unit: byte; so that it can be rewritten

void put_field(std::string& header, std::string_view name, std::string_view value) {
  put(header, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  header.append(name).append("=").append(value);
}

template <typename T>
void put_number_field(std::string& header, std::string_view name, T value) {
  std::string bytes;
  put(bytes, value);
  put_field(header, name, bytes);
}

void put_block(std::string& out, std::string_view block) {
  put(out, static_cast<std::uint32_t>(block.size()));
  out.append(block);
}

std::uint64_t ros_time(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1000000000;
  const std::int64_t seconds = stamp_ns / kSecond;
  if (stamp_ns <= 0 || seconds > std::numeric_limits<std::uint32_t>::max()) {
    throw RunError("a ROS bag cannot hold the stamp " + std::to_string(stamp_ns) +
                   " ns: ROS times lie between 1 ns and 2^32 s, 0 meaning none");
  }
  return static_cast<std::uint64_t>(seconds) | static_cast<std::uint64_t>(stamp_ns % kSecond) << 32;
}

bool earlier(std::uint64_t a, std::uint64_t b) {
  const auto key = [](std::uint64_t t) { return (t << 32) | (t >> 32); };
  return key(a) < key(b);
}

// An LZ4 frame as roslz4 accepts it: independent blocks, a checksum of the content, no size.
std::string compress_lz4(std::string_view bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string out(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  const std::size_t size =
      LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences);
  if (LZ4F_isError(size)) throw RunError(std::string("LZ4: ") + LZ4F_getErrorName(size));
  out.resize(size);
  return out;
}

}  // namespace

BagWriter::BagWriter(const std::string& path, BagCompression compression)
    : file_(path), compression_(compression) {
  file_.write(bag::kMagic);
  file_.write(file_header(0));
}

std::string BagWriter::file_header(std::uint64_t index_position) const {
  std::string fields;
  put_number_field(fields, "chunk_count", static_cast<std::uint32_t>(chunks_.size()));
  put_number_field(fields, "conn_count", static_cast<std::uint32_t>(topics_.size()));
  put_number_field(fields, "index_pos", index_position);
  put_number_field(fields, "op", bag::kFileHeader);
  std::string record;
  put_block(record, fields);
  put_block(record, std::string(kFileHeaderSize - fields.size(), ' '));
  return record;
}

std::uint32_t BagWriter::add_connection(const BagTopic& topic) {
  topics_.push_back(topic);
  announced_.push_back(false);
  index_.emplace_back();
  return static_cast<std::uint32_t>(topics_.size() - 1);
}

std::string BagWriter::connection_record(std::uint32_t connection) const {
  const BagTopic& topic = topics_[connection];
  std::string header, data, record;
  put_number_field(header, "conn", connection);
  put_number_field(header, "op", bag::kConnection);
  put_field(header, "topic", topic.topic);
  put_field(data, "callerid", "/rubble");
  if (topic.latching) put_field(data, "latching", "1");
  put_field(data, "md5sum", topic.md5);
  put_field(data, "message_definition", topic.definition);
  put_field(data, "topic", topic.topic);
  put_field(data, "type", topic.type);
  put_block(record, header);
  put_block(record, data);
  return record;
}

void BagWriter::write(std::uint32_t connection, std::int64_t stamp_ns, std::string_view message) {
  const std::uint64_t time = ros_time(stamp_ns);
  if (!announced_[connection]) {
    chunk_ += connection_record(connection);
    announced_[connection] = true;
  }
  index_[connection].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  std::string header;
  put_number_field(header, "conn", connection);
  put_number_field(header, "op", bag::kMessageData);
  put_number_field(header, "time", time);
  put_block(chunk_, header);
  put_block(chunk_, message);
  if (chunk_.size() >= kBagChunkSize) close_chunk();
}

void BagWriter::close_chunk() {
  if (chunk_.empty()) return;
  ChunkInfo info{file_.size(), 0, 0, {}};
  for (const auto& entries : index_) {
    info.counts.push_back(static_cast<std::uint32_t>(entries.size()));
    for (const IndexEntry& entry : entries) {
      if (info.first_time == 0 || earlier(entry.time, info.first_time))
        info.first_time = entry.time;
      if (earlier(info.last_time, entry.time)) info.last_time = entry.time;
    }
  }
  write_chunk();
  write_chunk_index();
  chunks_.push_back(std::move(info));
  chunk_.clear();
}

void BagWriter::write_chunk() {
  const bool lz4 = compression_ == BagCompression::lz4;
  const std::string compressed = lz4 ? compress_lz4(chunk_) : std::string();
  const std::string& data = lz4 ? compressed : chunk_;
  std::string fields, header;
  put_field(fields, "compression", lz4 ? "lz4" : "none");
  put_number_field(fields, "op", bag::kChunk);
  put_number_field(fields, "size", static_cast<std::uint32_t>(chunk_.size()));
  put_block(header, fields);
  put(header, static_cast<std::uint32_t>(data.size()));
  file_.write(header);
  file_.write(data);
}

void BagWriter::write_chunk_index() {
  for (std::uint32_t connection = 0; connection < index_.size(); ++connection) {
    auto& entries = index_[connection];
    if (entries.empty()) continue;
    std::string fields, data, record;
    put_number_field(fields, "conn", connection);
    put_number_field(fields, "count", static_cast<std::uint32_t>(entries.size()));
    put_number_field(fields, "op", bag::kIndexData);
    put_number_field(fields, "ver", std::uint32_t{1});
    for (const IndexEntry& entry : entries) {
      put(data, entry.time);
      put(data, entry.offset);
    }
    put_block(record, fields);
    put_block(record, data);
    file_.write(record);
    entries.clear();
  }
}

void BagWriter::finish() {
  close_chunk();
  const std::uint64_t index_position = file_.size();
  for (std::uint32_t c = 0; c < topics_.size(); ++c) file_.write(connection_record(c));
  for (const ChunkInfo& info : chunks_) {
    std::string fields, data, record;
    for (std::uint32_t c = 0; c < info.counts.size(); ++c) {
      if (info.counts[c] == 0) continue;
      put(data, c);
      put(data, info.counts[c]);
    }
    put_number_field(fields, "chunk_pos", info.position);
    put_number_field(fields, "count", static_cast<std::uint32_t>(data.size() / 8));
    put_number_field(fields, "end_time", info.last_time);
    put_number_field(fields, "op", bag::kChunkInfo);
    put_number_field(fields, "start_time", info.first_time);
    put_number_field(fields, "ver", std::uint32_t{1});
    put_block(record, fields);
    put_block(record, data);
    file_.write(record);
  }
  file_.overwrite(bag::kMagic.size(), file_header(index_position));
  file_.commit();
}

}  // namespace rubble
