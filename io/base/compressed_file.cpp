#include "io/base/compressed_file.h"

#include <algorithm>
#include <vector>
#include <zlib.h>

#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr int kGzipWindow = 15 + 16;  // the largest window; +16: a gzip header

class GzipChecker {
 public:
  explicit GzipChecker(const std::string& path) : file_(path), out_(1 << 16) {
    if (inflateInit2(&stream_, kGzipWindow) != Z_OK) throw RunError("zlib cannot start");
  }
  ~GzipChecker() { inflateEnd(&stream_); }
  GzipChecker(const GzipChecker&) = delete;
  GzipChecker& operator=(const GzipChecker&) = delete;

  void check() {
    if (file_.left() == 0) fail_at(0, "the file is empty");
    while (more()) {
      member_ = position();
      check_member();
      inflateReset(&stream_);
    }
  }

 private:
  std::uint64_t position() const { return file_.at() - stream_.avail_in; }

  // Whether there are bytes to read.
  bool more() {
    if (stream_.avail_in > 0) return true;
    block_ = file_.take(std::min<std::uint64_t>(file_.left(), 1 << 20), "a block");
    stream_.next_in = reinterpret_cast<Bytef*>(block_.data());
    stream_.avail_in = static_cast<uInt>(block_.size());
    return !block_.empty();
  }

  void check_member() {
    for (;;) {
      if (!more())
        fail_at(file_.size(), "the file ends within the gzip member that begins at byte " +
                                  std::to_string(member_));
      stream_.next_out = out_.data();
      stream_.avail_out = static_cast<uInt>(out_.size());
      const int result = inflate(&stream_, Z_NO_FLUSH);
      if (result == Z_STREAM_END) return;
      if (result != Z_OK)
        fail_at(position(),
                "the gzip member that begins at byte " + std::to_string(member_) +
                    " is damaged: " + (stream_.msg ? stream_.msg : "no more can be read"));
    }
  }

  FileCursor file_;
  z_stream stream_{};
  std::string block_;  // being read
  std::vector<Bytef> out_;
  std::uint64_t member_ = 0;  // where it begins
};

}  // namespace

std::optional<FileFault> check_gzip(const std::string& path) {
  try {
    GzipChecker(path).check();
  } catch (const FaultFound& found) {
    return found.fault;
  }
  return std::nullopt;
}

std::string make_gzip_member(std::string_view bytes, int level) {
  constexpr int kMemory = 9;  // the most that zlib may use: 256 KB more, and faster
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, kGzipWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw RunError("zlib cannot start at level " + std::to_string(level));
  }
  // The bound forgets some bytes of a few stored ones.
  std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END)
    throw RunError("zlib cannot compress " + std::to_string(bytes.size()) + " bytes");
  return out;
}

namespace {

constexpr std::uint32_t kEnd = 0x06054b50, kCentral = 0x02014b50, kLocal = 0x04034b50;
constexpr std::uint16_t kZip64 = 1;
constexpr std::size_t kEndSize = 22, kCentralSize = 46, kLocalSize = 30, kLongestComment = 65535;  // unit: byte

template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
  T value{};
  std::string_view rest = bytes.substr(std::min(at, bytes.size()));
  take(rest, value);
  return value;
}

// ZIP64: sizes of 2^32 - 1 stand for those in an extra field, in this order.
void read_large_sizes(std::string_view extra, ZipEntry& entry) {
  while (extra.size() >= 4) {
    const auto kind = number_at<std::uint16_t>(extra, 0);
    const std::size_t size = number_at<std::uint16_t>(extra, 2);
    std::string_view content = extra.substr(4, size);
    if (kind == kZip64)
      for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.offset})
        if (*value == 0xffffffffu) take(content, *value);
    extra.remove_prefix(std::min(extra.size(), 4 + size));
  }
}

}  // namespace

std::vector<ZipEntry> list_zip(std::string_view archive) {
  std::vector<ZipEntry> entries;
  if (archive.size() < kEndSize) return entries;
  const std::size_t last = archive.size() - kEndSize;
  std::size_t end = last;
  while (number_at<std::uint32_t>(archive, end) != kEnd) {
    if (end == 0 || last - end >= kLongestComment) return entries;
    --end;
  }
  const auto count = number_at<std::uint16_t>(archive, end + 10);
  std::size_t at = number_at<std::uint32_t>(archive, end + 16);
  for (int i = 0; i < count; ++i) {
    if (at > archive.size() || archive.size() - at < kCentralSize || number_at<std::uint32_t>(archive, at) != kCentral) break;
    const std::size_t name = number_at<std::uint16_t>(archive, at + 28), extra = number_at<std::uint16_t>(archive, at + 30),
                      comment = number_at<std::uint16_t>(archive, at + 32);
    ZipEntry entry;
    entry.method = number_at<std::uint16_t>(archive, at + 10);
    if (number_at<std::uint16_t>(archive, at + 8) & 1) entry.method = -1;  // encrypted
    entry.packed = number_at<std::uint32_t>(archive, at + 20);
    entry.size = number_at<std::uint32_t>(archive, at + 24);
    entry.offset = number_at<std::uint32_t>(archive, at + 42);
    const std::string_view rest = archive.substr(at + kCentralSize);
    entry.name = std::string(rest.substr(0, name));
    if (name < rest.size()) read_large_sizes(rest.substr(name, extra), entry);
    entries.push_back(std::move(entry));
    at += kCentralSize + name + extra + comment;
  }
  return entries;
}

std::optional<std::string> read_zip_entry(std::string_view archive, const ZipEntry& entry, std::uint64_t limit) {
  if (entry.size > limit || entry.offset > archive.size() || archive.size() - entry.offset < kLocalSize) return std::nullopt;
  const auto local = std::size_t(entry.offset);
  if (number_at<std::uint32_t>(archive, local) != kLocal) return std::nullopt;
  const std::size_t begin = local + kLocalSize + number_at<std::uint16_t>(archive, local + 26) + number_at<std::uint16_t>(archive, local + 28);
  if (begin > archive.size() || entry.packed > archive.size() - begin) return std::nullopt;
  const std::string_view packed = archive.substr(begin, std::size_t(entry.packed));
  if (entry.method == 0) return std::string(packed);
  if (entry.method != 8) return std::nullopt;
  std::string out(std::size_t(entry.size), '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = uInt(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  const int result = inflate(&stream, Z_FINISH);
  const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  return whole ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace rubble
