#include "render/gl/gl_exchange.h"

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

void GlReadback::ask(int width, int height, GLenum format, GLenum type) {
  bytes_ = std::size_t(width) * std::size_t(height) * bytes_of_pixel(format, type);
  if (bytes_ > room_) gl_->NamedBufferData(buffer_.name(), GLsizeiptr(bytes_), nullptr, GL_STREAM_READ);
  room_ = bytes_ > room_ ? bytes_ : room_;
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
  gl_->ReadPixels(0, 0, width, height, format, type, nullptr);
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  waits_ = gl_->traffic->waits;
}

void GlReadback::take(void* pixels) { take_buffer(*gl_, buffer_.name(), 0, bytes_, pixels, gl_->traffic->waits == waits_); }

}  // namespace rubble
