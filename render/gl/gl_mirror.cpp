#include "render/gl/gl_mirror.h"

#include <algorithm>
#include <cstring>

namespace rubble {

namespace {

constexpr std::size_t kBlock = 512;  // that is handed over together; unit: byte

}  // namespace

void GlMirror::give(const void* data, std::size_t bytes) {
  if (bytes == there_.size() && bytes > 0) return give_part(data, 0, bytes);
  const char* from = static_cast<const char*>(data);
  there_.assign(from, from + bytes);
  // GL refuses size 0.
  give_buffer(*gl_, buffer_.name(), std::max<std::size_t>(bytes, 16), bytes ? data : nullptr, GL_DYNAMIC_DRAW);
}

void GlMirror::give_part(const void* data, std::size_t begin, std::size_t end) {
  const char* from = static_cast<const char*>(data);
  std::size_t first = end;  // of a run of blocks that differ
  const auto give_run = [&](std::size_t last) {
    if (first < last) give_buffer_part(*gl_, buffer_.name(), first, last - first, from + first);
    first = end;
  };
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    if (std::memcmp(&there_[i], from + i, count) == 0) {
      give_run(i);
    } else {
      std::memcpy(&there_[i], from + i, count);
      first = std::min(first, i);
    }
  }
  give_run(end);
}

}  // namespace rubble
