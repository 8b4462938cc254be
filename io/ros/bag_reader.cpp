#include <lz4frame.h>

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "io/base/little_endian.h"
#include "io/ros/bag_format.h"
#include "io/ros/ros_message_reader.h"
#include "io/ros/unpacked_bytes.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr std::uint32_t kLargestHeader = 1 << 20;  // unit: byte

// The fields of a record's header, and its data.
struct Record {
  std::uint64_t byte = 0;  // where it begins, in the file or in its chunk
  std::map<std::string, std::string, std::less<>> fields;
  std::string data;
};

// A header's fields; false: it is none.
bool parse_fields(std::string_view header, Record& record) {
  while (!header.empty()) {
    std::uint32_t size = 0;
    if (!take(header, size) || size > header.size()) return false;
    const std::string_view field = header.substr(0, size);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return false;
    record.fields[std::string(field.substr(0, equals))] = field.substr(equals + 1);
    header.remove_prefix(size);
  }
  return true;
}

template <typename T>
T field(const Record& record, std::string_view name) {
  const auto found = record.fields.find(name);
  T value{};
  if (found == record.fields.end() || found->second.size() != sizeof value)
    fail_at(record.byte, "the record there has no field `" + std::string(name) + "`");
  found->second.copy(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

std::string text_field(const Record& record, std::string_view name) {
  const auto found = record.fields.find(name);
  if (found == record.fields.end())
    fail_at(record.byte, "the record there has no field `" + std::string(name) + "`");
  return found->second;
}

Record read_record(FileCursor& file) {
  Record record;
  record.byte = file.at();
  const auto header_size = file.number<std::uint32_t>("the length of a record");
  if (header_size > kLargestHeader)
    fail_at(record.byte, "no record begins there: its header would have " +
                             std::to_string(header_size) + " bytes");
  if (!parse_fields(file.take(header_size, "the header of a record"), record))
    fail_at(record.byte, "the record there has a damaged header");
  const auto data_size = file.number<std::uint32_t>("the length of a record");
  record.data = file.take(data_size, "a record");
  return record;
}

std::string decompress_lz4(const Record& chunk, std::uint32_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
    throw RunError("LZ4 cannot start");
  UnpackedBytes out(size);
  std::size_t read = 0, hint = 1;
  while (hint != 0 && read < chunk.data.size()) {
    std::size_t room = out.room(), there = chunk.data.size() - read;
    hint = LZ4F_decompress(context, out.end(), &room, chunk.data.data() + read, &there, nullptr);
    if (LZ4F_isError(hint) || (room == 0 && there == 0)) break;
    read += there, out.add(room);
  }
  const bool whole = hint == 0 && out.whole() && read == chunk.data.size();
  LZ4F_freeDecompressionContext(context);
  if (!whole)
    fail_at(chunk.byte, "the chunk there, of " + std::to_string(chunk.data.size()) +
                            " bytes, is damaged: it does not give the " + std::to_string(size) +
                            " bytes that its checksum is of");
  return out.take();
}

std::string content_of(const Record& chunk, const std::string& path) {
  const auto size = field<std::uint32_t>(chunk, "size");
  const std::string compression = text_field(chunk, "compression");
  if (compression == "lz4") return decompress_lz4(chunk, size);
  if (compression != "none")
    throw InputError({path, 0, "", "its chunks are compressed by " + compression, "lz4 or none", "",
                      "`rosbag decompress` makes one that can be looked into"});
  if (size != chunk.data.size())
    fail_at(chunk.byte, "the chunk there has another size than it says");
  return chunk.data;
}

class BagReader {
 public:
  BagReader(const std::string& path, const TakeRosMessage& take)
      : path_(path), file_(path), take_(take) {}

  void read() {
    if (file_.take(std::min<std::uint64_t>(bag::kMagic.size(), file_.left()), "") != bag::kMagic)
      fail_at(0, "it is no ROS bag of format 2.0");
    const Record header = read_record(file_);
    if (field<std::uint8_t>(header, "op") != bag::kFileHeader)
      fail_at(header.byte, "the header of the file is missing");
    const auto index_position = field<std::uint64_t>(header, "index_pos");
    if (index_position == 0)
      fail_at(header.byte, "it has no index: whoever wrote it was stopped before the end");
    if (header.data.find_first_not_of(' ') != std::string::npos)
      fail_at(header.byte, "the header of the file is damaged");
    while (file_.left() > 0 && !enough_)
      file_.at() < index_position ? read_chunk_or_index() : read_summary(index_position);
    if (enough_) return;
    if (chunks_.size() != field<std::uint32_t>(header, "chunk_count") ||
        listed_chunks_ != chunks_.size() || listed_ != field<std::uint32_t>(header, "conn_count"))
      fail_at(file_.size(), "the file ends before its index is complete");
  }

 private:
  struct Entry {
    std::uint32_t connection;
    std::uint64_t time;
  };

  void read_chunk_or_index() {
    const Record record = read_record(file_);
    const auto op = field<std::uint8_t>(record, "op");
    if (op == bag::kChunk)
      read_chunk(record);
    else if (op == bag::kIndexData)
      check_index(record);
    else
      fail_at(record.byte, "a chunk or its index should be there");
  }

  void read_chunk(const Record& chunk) {
    check_all_indexed(chunk.byte);
    chunks_.insert(chunk.byte);
    const std::string content = content_of(chunk, path_);
    std::string_view left = content;
    while (!left.empty() && !enough_) read_within(chunk.byte, content.size() - left.size(), left);
  }

  void read_within(std::uint64_t chunk, std::uint64_t offset, std::string_view& left) {
    Record record;
    record.byte = chunk;
    std::uint32_t header_size = 0, size = 0;
    const auto sound = [&](bool true_so_far) {
      if (!true_so_far)
        fail_at(chunk, "in the chunk there, the record at its byte " + std::to_string(offset) +
                           " is damaged");
    };
    sound(take(left, header_size) && header_size <= left.size());
    sound(parse_fields(left.substr(0, header_size), record));
    left.remove_prefix(header_size);
    sound(take(left, size) && size <= left.size());
    const std::string_view data = left.substr(0, size);
    left.remove_prefix(size);
    const auto op = field<std::uint8_t>(record, "op");
    const auto connection = field<std::uint32_t>(record, "conn");
    if (op == bag::kConnection) {
      topics_[connection] = text_field(record, "topic");
      announced_[connection] = std::string(data);
      Record about;
      if (parse_fields(data, about)) types_[connection] = about.fields["type"];
      return;
    }
    sound(op == bag::kMessageData && topics_.count(connection));
    entries_[std::uint32_t(offset)] = {connection, field<std::uint64_t>(record, "time")};
    enough_ = !take_({ros::Version::ros1, topics_[connection], data, types_[connection]});
  }

  // Behind each chunk: where in it the messages of a connection are.
  void check_index(const Record& record) {
    const auto connection = field<std::uint32_t>(record, "conn");
    std::string_view data = record.data;
    for (auto count = field<std::uint32_t>(record, "count"); count > 0; --count) {
      std::uint64_t time = 0;
      std::uint32_t offset = 0;
      const bool there = take(data, time) && take(data, offset);
      const auto entry = entries_.find(offset);
      if (!there || entry == entries_.end() || entry->second.connection != connection ||
          entry->second.time != time)
        fail_at(record.byte, "the index there does not fit the chunk before it");
      entries_.erase(entry);
    }
    if (!data.empty()) fail_at(record.byte, "the index there is longer than it says");
  }

  void check_all_indexed(std::uint64_t byte) {
    if (!entries_.empty())
      fail_at(byte, "the index before that misses a message of the chunk before it");
  }

  // At the end: all connections again, and where the chunks are.
  void read_summary(std::uint64_t index_position) {
    if (listed_ == 0 && file_.at() != index_position)
      fail_at(file_.at(), "the index begins elsewhere than the header of the file says");
    check_all_indexed(file_.at());
    const Record record = read_record(file_);
    const auto op = field<std::uint8_t>(record, "op");
    if (op == bag::kConnection) {
      const auto connection = field<std::uint32_t>(record, "conn");
      const auto known = announced_.find(connection);
      if (known != announced_.end() &&
          (known->second != record.data || topics_[connection] != text_field(record, "topic")))
        fail_at(record.byte, "the connection there is another than in its chunk");
      ++listed_;
    } else if (op == bag::kChunkInfo) {
      if (!chunks_.count(field<std::uint64_t>(record, "chunk_pos")))
        fail_at(record.byte, "the index there names a chunk that is not there");
      ++listed_chunks_;
    } else {
      fail_at(record.byte, "a part of the index should be there");
    }
  }

  const std::string& path_;
  FileCursor file_;
  const TakeRosMessage& take_;
  bool enough_ = false;
  std::map<std::uint32_t, std::string> topics_, types_, announced_;  // by connection: name, type, description
  std::map<std::uint32_t, Entry> entries_;  // messages of the chunk, by offset, not yet in an index
  std::set<std::uint64_t> chunks_;          // where they begin
  std::size_t listed_ = 0, listed_chunks_ = 0;
};

}  // namespace

std::optional<FileFault> read_bag(const std::string& path, const TakeRosMessage& take) {
  try {
    BagReader(path, take).read();
  } catch (const FaultFound& found) {
    return found.fault;
  }
  return std::nullopt;
}

}  // namespace rubble
