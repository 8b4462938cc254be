// A buffer on the card whose content is known here, so that only what has changed is handed over. Internal to render/.
#pragma once

#include <cstddef>
#include <vector>

#include "render/gl/gl_objects.h"

namespace rubble {

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

}  // namespace rubble
