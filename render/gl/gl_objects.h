// Owners of GL objects. Internal to render/.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/gl/gl.h"
#include "render/gl/gl_traffic.h"

namespace rubble {

// Owns one GL name; Kind says how it is made and deleted.
template <typename Kind>
class GlObject {
 public:
  GlObject() = default;
  template <typename... Args>
  explicit GlObject(const Gl& gl, Args... args) : gl_(&gl), name_(Kind::make(gl, args...)) {}
  ~GlObject() { reset(); }
  GlObject(GlObject&& other) noexcept { *this = std::move(other); }
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }
  void reset() {
    if (name_) Kind::drop(*gl_, name_);
    name_ = 0;
  }

 private:
  const Gl* gl_ = nullptr;
  GLuint name_ = 0;
};

struct BufferKind {
  static GLuint make(const Gl& gl) {
    GLuint n = 0;
    gl.CreateBuffers(1, &n);
    return n;
  }
  static void drop(const Gl& gl, GLuint n) { gl.DeleteBuffers(1, &n); }
};
struct TextureKind {
  static GLuint make(const Gl& gl, GLenum target) {
    GLuint n = 0;
    gl.CreateTextures(target, 1, &n);
    return n;
  }
  // For TextureView: a name that is no texture yet.
  static GLuint make(const Gl& gl) {
    GLuint n = 0;
    gl.GenTextures(1, &n);
    return n;
  }
  static void drop(const Gl& gl, GLuint n) { gl.DeleteTextures(1, &n); }
};
struct FramebufferKind {
  static GLuint make(const Gl& gl) {
    GLuint n = 0;
    gl.CreateFramebuffers(1, &n);
    return n;
  }
  static void drop(const Gl& gl, GLuint n) { gl.DeleteFramebuffers(1, &n); }
};
struct VertexArrayKind {
  static GLuint make(const Gl& gl) {
    GLuint n = 0;
    gl.CreateVertexArrays(1, &n);
    return n;
  }
  static void drop(const Gl& gl, GLuint n) { gl.DeleteVertexArrays(1, &n); }
};
struct ProgramKind {
  static GLuint make(const Gl& gl) { return gl.CreateProgram(); }
  static void drop(const Gl& gl, GLuint n) { gl.DeleteProgram(n); }
};

using GlBuffer = GlObject<BufferKind>;
using GlTexture = GlObject<TextureKind>;
using GlFramebuffer = GlObject<FramebufferKind>;
using GlVertexArray = GlObject<VertexArrayKind>;
using GlProgram = GlObject<ProgramKind>;

// A buffer that holds `data`; an empty vector gives a small buffer, since GL refuses size 0.
template <typename T, typename Memory>
GlBuffer make_buffer(const Gl& gl, const std::vector<T, Memory>& data, GLenum usage = GL_STATIC_DRAW) {
  GlBuffer buffer(gl);
  const std::size_t size = data.size() * sizeof(T);
  give_buffer(gl, buffer.name(), size ? size : 16, size ? data.data() : nullptr, usage);
  return buffer;
}

// A one-dimensional array of texels that shaders read by index.
GlTexture make_buffer_texture(const Gl& gl, const GlBuffer& buffer, GLenum format);

// A single-level 2D texture without filtering, to draw into.
GlTexture make_target(const Gl& gl, GLenum format, int width, int height);

// Throws RunError naming `what` when GL has recorded an error, out of memory above all.
void check_gl(const Gl& gl, const std::string& what);

}  // namespace rubble
