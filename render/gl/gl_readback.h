// Pixels that come back while the card goes on. Internal to render/.
#pragma once

#include <cstdint>

#include "render/gl/gl_objects.h"

namespace rubble {

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
