#include <zstd.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "io/base/little_endian.h"
#include "io/ros/mcap_format.h"
#include "io/ros/ros_message_reader.h"
#include "io/ros/unpacked_bytes.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using namespace mcap;

constexpr std::uint64_t kFooterSize = 8 + 8 + 4;

bool take_text(std::string_view& bytes, std::string_view& text) {
  std::uint32_t size = 0;
  if (!take(bytes, size) || size > bytes.size()) return false;
  text = bytes.substr(0, size);
  bytes.remove_prefix(size);
  return true;
}

struct Chunk {
  std::uint64_t first_time = 0, last_time = 0, size = 0, packed_size = 0;
  std::uint32_t crc = 0;
  std::string_view compression;
};

// What precedes the compressed records of a chunk, which are left in `bytes`.
bool take_chunk_head(std::string_view& bytes, Chunk& chunk) {
  return take(bytes, chunk.first_time) && take(bytes, chunk.last_time) && take(bytes, chunk.size) &&
         take(bytes, chunk.crc) && take_text(bytes, chunk.compression) &&
         take(bytes, chunk.packed_size) && chunk.packed_size == bytes.size() &&
         chunk.size < kLargestRecord;
}

// Nothing: it does not give exactly so many bytes.
std::optional<std::string> unpack_zstd(std::string_view packed, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) throw RunError("zstd cannot start");
  UnpackedBytes out(size);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t hint = packed.empty() ? 0 : 1;  // 0: at the end of a frame
  while (hint != 0 || in.pos < in.size) {
    const std::size_t room = out.room();
    ZSTD_outBuffer part{out.end(), room, 0};
    const std::size_t before = in.pos;
    hint = ZSTD_decompressStream(stream.get(), &part, &in);
    out.add(part.pos);
    if (ZSTD_isError(hint) || (part.pos == 0 && in.pos == before)) return std::nullopt;
  }
  if (!out.whole()) return std::nullopt;
  return out.take();
}

class McapReader {
 public:
  McapReader(const std::string& path, const TakeRosMessage& take)
      : path_(path), file_(path), take_(take) {}

  void read() {
    if (read_bytes(std::min<std::uint64_t>(kMagic.size(), file_.left()), "") != kMagic)
      fail_at(0, "it is no MCAP file");
    while (!enough_ && read_record()) {
    }
    if (enough_) return;
    read_end();
  }

 private:
  // What is read here goes into the checksum of the data.
  std::string read_bytes(std::uint64_t count, const char* what) {
    std::string bytes = file_.take(count, what);
    crc_ = crc_of(crc_, bytes);
    return bytes;
  }

  // One record of the data; false: it was the last, and the summary begins.
  bool read_record() {
    const std::uint64_t byte = file_.at();
    const std::uint32_t crc = crc_;
    std::string head = read_bytes(9, "the head of a record");
    const auto opcode = std::uint8_t(head[0]);
    std::string_view rest = std::string_view(head).substr(1);
    std::uint64_t size = 0;
    take(rest, size);
    if (size > file_.left() + kLargestRecord)
      fail_at(byte, "no record begins there: it would have " + std::to_string(size) + " bytes");
    const std::string content = read_bytes(size, "a record");
    if (opcode == kDataEnd) return check_data(byte, crc, content), false;
    read_content(byte, opcode, content);
    return true;
  }

  void read_content(std::uint64_t byte, std::uint8_t opcode, std::string_view content) {
    if (opcode == kChannel)
      note_channel(byte, content);
    else if (opcode == kChunk)
      read_chunk(byte, content);
    else if (opcode == kMessageIndex)
      check_index(byte, content);
    else if (opcode == kMessage)
      read_message(byte, content);
    else if (opcode == 0 || opcode > kDataEnd)
      fail_at(byte, "no record begins there: its kind would be " + std::to_string(opcode));
  }

  void note_channel(std::uint64_t byte, std::string_view content) {
    std::uint16_t channel = 0, schema = 0;
    std::string_view topic;
    if (!take(content, channel) || !take(content, schema) || !take_text(content, topic))
      fail_at(byte, "the channel there is damaged");
    topics_[channel] = topic;
  }

  void read_chunk(std::uint64_t byte, std::string_view content) {
    Chunk chunk;
    if (!take_chunk_head(content, chunk)) fail_at(byte, "the chunk there has a damaged head");
    const std::string records = unpack(byte, chunk, content);
    if (chunk.crc != 0 && crc_of(0, records) != chunk.crc) fail_chunk(byte, content.size());
    std::string_view left = records;
    offsets_.clear();
    while (!left.empty() && !enough_) {
      const std::uint64_t offset = records.size() - left.size();
      std::uint8_t opcode = 0;
      std::uint64_t size = 0;
      if (!take(left, opcode) || !take(left, size) || size > left.size())
        fail_at(byte, "in the chunk there, the record at its byte " + std::to_string(offset) +
                          " is damaged");
      if (opcode == kMessage) offsets_.insert(offset);
      if (opcode != kChunk) read_content(byte, opcode, left.substr(0, size));
      left.remove_prefix(size);
    }
  }

  [[noreturn]] static void fail_chunk(std::uint64_t byte, std::size_t size) {
    fail_at(byte, "the chunk there, of " + std::to_string(size) +
                      " bytes, is damaged: its content does not have its checksum");
  }

  std::string unpack(std::uint64_t byte, const Chunk& chunk, std::string_view packed) const {
    if (chunk.compression.empty()) return std::string(packed);
    if (chunk.compression != "zstd")
      throw InputError({path_, 0, "",
                        "its chunks are compressed by " + std::string(chunk.compression),
                        "zstd or none", "", "`mcap compress` makes one that can be looked into"});
    std::optional<std::string> out = unpack_zstd(packed, chunk.size);
    if (!out) fail_chunk(byte, packed.size());
    return std::move(*out);
  }

  void read_message(std::uint64_t byte, std::string_view content) {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
    std::uint64_t logged = 0, published = 0;
    if (!take(content, channel) || !take(content, sequence) || !take(content, logged) ||
        !take(content, published) || !topics_.count(channel))
      fail_at(byte, "a message there is damaged");
    enough_ = !take_({ros::Version::ros2, topics_[channel], content});
  }

  void check_index(std::uint64_t byte, std::string_view content) const {
    std::uint16_t channel = 0;
    std::uint32_t size = 0;
    bool sound = take(content, channel) && take(content, size) && size == content.size();
    for (std::uint64_t time = 0, offset = 0; sound && !content.empty();)
      sound = take(content, time) && take(content, offset) && offsets_.count(offset);
    if (!sound) fail_at(byte, "the index there does not fit the chunk before it");
  }

  // crc: of all bytes before the record.
  static void check_data(std::uint64_t byte, std::uint32_t crc, std::string_view content) {
    std::uint32_t stated = 0;
    if (!take(content, stated)) fail_at(byte, "the end of the data is damaged");
    if (stated != 0 && stated != crc)
      fail_at(byte, "the bytes before that do not have the checksum that stands there");
  }

  // The summary, the footer and the magic.
  void read_end() {
    const std::uint64_t summary = file_.at(), tail = 9 + kFooterSize + kMagic.size();
    if (file_.left() < tail) fail_at(file_.size(), "the file ends before its footer");
    const std::string bytes = file_.take(file_.left(), "the summary");
    std::string_view end = std::string_view(bytes).substr(bytes.size() - tail);
    std::uint8_t opcode = 0;
    std::uint64_t size = 0, summary_start = 0, offsets_start = 0;
    std::uint32_t stated = 0;
    take(end, opcode), take(end, size), take(end, summary_start), take(end, offsets_start);
    take(end, stated);
    if (opcode != kFooter || size != kFooterSize || end != kMagic)
      fail_at(file_.size() - tail, "the footer should be there");
    if (summary_start != summary)
      fail_at(file_.size() - tail, "the footer says that the summary begins elsewhere");
    const auto sealed = std::string_view(bytes).substr(0, bytes.size() - 4 - kMagic.size());
    if (stated != 0 && crc_of(0, sealed) != stated)
      fail_at(summary, "the summary there does not have the checksum of the footer");
  }

  const std::string& path_;
  FileCursor file_;
  const TakeRosMessage& take_;
  bool enough_ = false;
  std::uint32_t crc_ = 0;
  std::map<std::uint16_t, std::string> topics_;
  std::set<std::uint64_t> offsets_;  // of the messages in the chunk before
};

}  // namespace

std::optional<FileFault> read_mcap(const std::string& path, const TakeRosMessage& take) {
  try {
    McapReader(path, take).read();
  } catch (const FaultFound& found) {
    return found.fault;
  }
  return std::nullopt;
}

}  // namespace rubble
