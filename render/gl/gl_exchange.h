// Buffers between the processor and the card: what has changed goes there, and pixels come back while the card goes on.
// Internal to render/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/gl/gl_objects.h"

namespace rubble {

// A buffer on the card whose content is known here, so that only what has changed is handed over.
class GlMirror {
 public:
  explicit GlMirror(const Gl& gl) : gl_(&gl), buffer_(gl) {}
  GLuint name() const { return buffer_.name(); }
  const GlBuffer& buffer() const { return buffer_; }

  void give(const void* data, std::size_t bytes);
  // `data` differs from what was given there alone, and has the same size. unit: byte
  void give_part(const void* data, std::size_t begin, std::size_t end);
  std::size_t size() const { return there_.size(); }  // unit: byte
  template <typename T, typename Memory>
  void give(const std::vector<T, Memory>& values) {
    give(values.data(), values.size() * sizeof(T));
  }

 private:
  const Gl* gl_;
  GlBuffer buffer_;
  std::vector<char> there_;  // as the card has it
};

// Pixels that come back while the card goes on.
class GlReadback {
 public:
  explicit GlReadback(const Gl& gl) : gl_(&gl), buffer_(gl) {}

  // Of what is bound to read, rows from its first on.
  void ask(int width, int height, GLenum format, GLenum type);
  // What was asked for last. Waits, unless somebody has waited for the card since then.
  void take(void* pixels);

 private:
  const Gl* gl_;
  GlBuffer buffer_;
  std::size_t room_ = 0, bytes_ = 0;  // of the buffer; of what was asked for
  std::uint64_t waits_ = 0;           // GlTraffic::waits when it was
};

}  // namespace rubble
