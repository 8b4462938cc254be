#include "io/base/zip_file.h"

#include <zlib.h>

#include <algorithm>

#include "io/base/little_endian.h"

namespace rubble {
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
