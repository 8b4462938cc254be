#include "render/gl/gl_objects.h"

#include <cstdio>

#include "kernel/base/error.h"

namespace rubble {

GlTexture make_buffer_texture(const Gl& gl, const GlBuffer& buffer, GLenum format) {
  GlTexture texture(gl, GLenum(GL_TEXTURE_BUFFER));
  gl.TextureBuffer(texture.name(), format, buffer.name());
  return texture;
}

GlTexture make_target(const Gl& gl, GLenum format, int width, int height) {
  GlTexture texture(gl, GLenum(GL_TEXTURE_2D));
  gl.TextureStorage2D(texture.name(), 1, format, width, height);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

void check_gl(const Gl& gl, const std::string& what) {
  const GLenum code = gl.GetError();
  if (code == GL_NO_ERROR) return;
  if (code == GL_OUT_OF_MEMORY) throw RunError("the graphics device is out of memory: " + what);
  char text[32];
  std::snprintf(text, sizeof text, "0x%x", unsigned(code));
  throw RunError(std::string("OpenGL error ") + text + ": " + what);
}

}  // namespace rubble
