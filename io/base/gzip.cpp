#include "io/base/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <vector>

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

}  // namespace rubble
