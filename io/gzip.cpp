#include "io/gzip.h"

#include <zlib.h>

#include "kernel/base/error.h"

namespace rubble {

std::string make_gzip_member(std::string_view bytes, int level) {
  constexpr int kGzipWindow = 15 + 16;  // the largest window; +16: a gzip header
  constexpr int kMemory = 9;            // the most that zlib may use: 256 KB more, and faster
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
