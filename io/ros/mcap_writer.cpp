#include "io/ros/mcap_writer.h"

#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "io/base/little_endian.h"
#include "io/ros/mcap_format.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using namespace mcap;

// Large enough to compress well, small enough that one picture of 1024x1024 is a chunk of its own
// and the threads share the work evenly. unit: byte
constexpr std::size_t kMcapChunkSize = 1 << 20;
constexpr int kZstdLevel = 1;

void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

std::string record(Opcode opcode, std::string_view content) {
  std::string out;
  put(out, static_cast<std::uint8_t>(opcode));
  put(out, static_cast<std::uint64_t>(content.size()));
  out.append(content);
  return out;
}

std::string compress_zstd(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw RunError(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

// One group of the summary: its records and where they begin.
struct Group {
  Opcode opcode;
  std::string records;
};

}  // namespace

McapWriter::McapWriter(const std::string& path, McapCompression compression, int threads)
    : file_(path), compression_(compression), tasks_(threads) {
  std::string header;
  put_text(header, "ros2");
  put_text(header, "rubble");
  write_bytes(kMagic);
  write_bytes(record(kHeader, header));
}

void McapWriter::write_bytes(std::string_view bytes) {
  crc_ = crc_of(crc_, bytes);
  file_.write(bytes);
}

std::uint16_t McapWriter::add_channel(const McapTopic& topic) {
  topics_.push_back(topic);
  if (schema_of(topic) == 0) types_.push_back(topic);
  counts_.push_back(0);
  chunk_.index.emplace_back();
  return static_cast<std::uint16_t>(topics_.size() - 1);
}

// Numbers begin at 1: 0 means "none" in the format.
std::uint16_t McapWriter::schema_of(const McapTopic& topic) const {
  for (std::size_t i = 0; i < types_.size(); ++i)
    if (types_[i].type == topic.type && types_[i].schema == topic.schema) return static_cast<std::uint16_t>(i + 1);
  return 0;
}

// One for each type: readers look a type up by its name and take the channels of the first schema that has it.
std::string McapWriter::schemas() const {
  std::string out;
  for (std::size_t i = 0; i < types_.size(); ++i) {
    std::string content;
    put(content, static_cast<std::uint16_t>(i + 1));
    put_text(content, types_[i].type);
    put_text(content, "ros2msg");
    put_text(content, types_[i].schema);
    out += record(kSchema, content);
  }
  return out;
}

std::string McapWriter::channels() const {
  std::string out;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    std::string metadata, content;
    put_text(metadata, "offered_qos_profiles");
    put_text(metadata, topics_[i].qos);
    put(content, static_cast<std::uint16_t>(i));
    put(content, schema_of(topics_[i]));
    put_text(content, topics_[i].topic);
    put_text(content, "cdr");
    put_text(content, metadata);
    out += record(kChannel, content);
  }
  return out;
}

void McapWriter::write(std::uint16_t channel, std::int64_t stamp_ns, std::string_view message) {
  if (stamp_ns < 0)
    throw RunError("an MCAP file cannot hold the stamp " + std::to_string(stamp_ns) + " ns");
  const auto time = static_cast<std::uint64_t>(stamp_ns);
  const bool first = std::all_of(counts_.begin(), counts_.end(), [](std::uint32_t count) { return count == 0; });
  first_time_ = first ? time : std::min(first_time_, time);
  last_time_ = std::max(last_time_, time);
  std::string& out = chunk_.records;
  if (out.empty()) chunk_.first_time = chunk_.last_time = time;
  chunk_.first_time = std::min(chunk_.first_time, time);
  chunk_.last_time = std::max(chunk_.last_time, time);
  chunk_.index[channel].push_back({time, out.size()});
  put(out, static_cast<std::uint8_t>(kMessage));
  put(out, static_cast<std::uint64_t>(2 + 4 + 8 + 8 + message.size()));
  put(out, channel);
  put(out, counts_[channel]++);
  put(out, time);  // logged ...
  put(out, time);  // ... and published: simulation has no delay
  out.append(message);
  if (out.size() >= kMcapChunkSize) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  if (!announced_) write_bytes(schemas() + channels());
  announced_ = true;
  auto chunk = std::make_shared<Chunk>(std::move(chunk_));
  chunk_ = {};
  chunk_.index.resize(topics_.size());
  tasks_.add([this, chunk]() -> OrderedTasks::Commit {
    const bool zstd = compression_ == McapCompression::zstd;
    const std::string packed = zstd ? compress_zstd(chunk->records) : std::string();
    const std::string& data = zstd ? packed : chunk->records;
    std::string content;
    content.reserve(data.size() + 128);
    put(content, chunk->first_time);
    put(content, chunk->last_time);
    put(content, static_cast<std::uint64_t>(chunk->records.size()));
    put(content, crc_of(0, chunk->records));
    put_text(content, zstd ? "zstd" : "");
    put(content, static_cast<std::uint64_t>(data.size()));
    content += data;
    const auto bytes = std::make_shared<const std::string>(record(kChunk, content));
    return [this, chunk, bytes, crc = crc_of(0, *bytes), size = data.size()] {
      write_chunk(*chunk, *bytes, crc, size);
    };
  });
}

void McapWriter::write_chunk(const Chunk& chunk, const std::string& bytes, std::uint32_t crc,
                             std::uint64_t compressed_size) {
  ChunkInfo info{chunk.first_time, chunk.last_time,     file_.size(), bytes.size(), {}, 0,
                 compressed_size,  chunk.records.size()};
  crc_ = static_cast<std::uint32_t>(crc32_combine(crc_, crc, static_cast<z_off_t>(bytes.size())));
  file_.write(bytes);
  const std::uint64_t index_start = file_.size();
  for (std::size_t c = 0; c < chunk.index.size(); ++c) {
    info.index_positions.push_back(chunk.index[c].empty() ? 0 : file_.size());
    if (chunk.index[c].empty()) continue;
    std::string content;
    put(content, static_cast<std::uint16_t>(c));
    put(content, static_cast<std::uint32_t>(16 * chunk.index[c].size()));
    for (const IndexEntry& entry : chunk.index[c]) {
      put(content, entry.time);
      put(content, entry.offset);
    }
    write_bytes(record(kMessageIndex, content));
  }
  info.index_length = file_.size() - index_start;
  chunks_.push_back(std::move(info));
}

std::string McapWriter::chunk_indexes() const {
  std::string out;
  for (const ChunkInfo& chunk : chunks_) {
    std::string offsets, content;
    for (std::size_t c = 0; c < chunk.index_positions.size(); ++c) {
      if (chunk.index_positions[c] == 0) continue;
      put(offsets, static_cast<std::uint16_t>(c));
      put(offsets, chunk.index_positions[c]);
    }
    for (const std::uint64_t number :
         {chunk.first_time, chunk.last_time, chunk.position, chunk.length})
      put(content, number);
    put_text(content, offsets);
    put(content, chunk.index_length);
    put_text(content, compression_ == McapCompression::zstd ? "zstd" : "");
    put(content, chunk.compressed_size);
    put(content, chunk.size);
    out += record(kChunkIndex, content);
  }
  return out;
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0, first = std::numeric_limits<std::uint64_t>::max(), last = 0;
  std::string per_channel, content;
  for (std::size_t c = 0; c < counts_.size(); ++c) {
    messages += counts_[c];
    put(per_channel, static_cast<std::uint16_t>(c));
    put(per_channel, std::uint64_t{counts_[c]});
  }
  for (const ChunkInfo& chunk : chunks_) {
    first = std::min(first, chunk.first_time);
    last = std::max(last, chunk.last_time);
  }
  put(content, messages);
  put(content, static_cast<std::uint16_t>(types_.size()));   // schemas
  put(content, static_cast<std::uint32_t>(topics_.size()));  // channels
  put(content, std::uint32_t{0});                            // attachments
  put(content, std::uint32_t{0});                            // metadata
  put(content, static_cast<std::uint32_t>(chunks_.size()));
  put(content, messages ? first : 0);
  put(content, last);
  put_text(content, per_channel);
  return record(kStatistics, content);
}

McapSummary McapWriter::summary() const {
  return {topics_, counts_, static_cast<std::int64_t>(first_time_), static_cast<std::int64_t>(last_time_)};
}

void McapWriter::finish() {
  close_chunk();
  tasks_.finish();
  std::string end;
  put(end, crc_);
  file_.write(record(kDataEnd, end));

  const std::uint64_t summary_start = file_.size();
  std::string summary, offsets;
  for (const Group& group :
       {Group{kSchema, schemas()}, Group{kChannel, channels()}, Group{kStatistics, statistics()},
        Group{kChunkIndex, chunk_indexes()}}) {
    if (group.records.empty()) continue;
    std::string content;
    put(content, static_cast<std::uint8_t>(group.opcode));
    put(content, static_cast<std::uint64_t>(summary_start + summary.size()));
    put(content, static_cast<std::uint64_t>(group.records.size()));
    offsets += record(kSummaryOffset, content);
    summary += group.records;
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary += offsets;
  // The checksum covers the footer up to itself.
  std::string footer;
  put(footer, static_cast<std::uint8_t>(kFooter));
  put(footer, std::uint64_t{8 + 8 + 4});
  put(footer, summary_start);
  put(footer, offsets_start);
  summary += footer;
  put(summary, crc_of(0, summary));
  file_.write(summary);
  file_.write(kMagic);
  file_.commit();
}

}  // namespace rubble
