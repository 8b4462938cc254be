#include "render/gl/gl_readback.h"

#include "render/gl/gl_traffic.h"

namespace rubble {

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
