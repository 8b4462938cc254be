// Buffers between the processor and the card: what has changed goes there, and pixels come back while the card goes on.
// Internal to render/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
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

// Bytes that were asked of the card, and come back while it and the processor go on.
class GlComing {
 public:
  explicit GlComing(const Gl& gl) : gl_(&gl), buffer_(gl) {}
  ~GlComing();
  GlComing(const GlComing&) = delete;
  GlComing& operator=(const GlComing&) = delete;

  std::size_t size() const { return bytes_; }  // unit: byte
  GLuint name() const { return buffer_.name(); }
  void sign();  // all of it is asked for
  // Waits until the card has done what was asked of it before, and no longer.
  void take(void* to, std::size_t offset, std::size_t bytes);
  void take(void* to) { take(to, 0, bytes_); }

 private:
  friend class GlReadback;
  void make_room(std::size_t bytes);

  const Gl* gl_;
  GlBuffer buffer_;
  const char* memory_ = nullptr;  // of the buffer
  GLsync fence_ = nullptr;
  std::size_t room_ = 0, bytes_ = 0;  // of the buffer; of what was asked for
  std::uint64_t asked_ = 0;           // as GlTraffic::asked
};

class GlReadback {
 public:
  explicit GlReadback(const Gl& gl) : gl_(&gl) {}

  // Of what is bound to read, rows from its first on.
  std::shared_ptr<GlComing> ask(int width, int height, GLenum format, GLenum type);
  // For what writes there itself.
  std::shared_ptr<GlComing> open(std::size_t bytes);
  struct Part {
    GLuint buffer;
    std::size_t offset, bytes;
  };
  // Of buffers, one after the other.
  std::shared_ptr<GlComing> ask(const std::vector<Part>& parts);

 private:
  const Gl* gl_;
  std::vector<std::shared_ptr<GlComing>> all_;  // those that nobody else has are free
};

}  // namespace rubble
