#include "render/gl/gl_traffic.h"

namespace rubble {

namespace {

void count_wait(const Gl& gl) {
  ++gl.traffic->waits;
  gl.traffic->done = gl.traffic->asked;
}

}  // namespace

std::size_t bytes_of_pixel(GLenum format, GLenum type) {
  const bool one = format == GL_RED || format == GL_RED_INTEGER || format == GL_DEPTH_COMPONENT;
  const bool two = format == GL_RG || format == GL_RG_INTEGER;
  const std::size_t channels = one ? 1 : two ? 2 : format == GL_RGB ? 3 : 4;
  return channels * (type == GL_UNSIGNED_BYTE ? 1 : 4);
}

void give_buffer(const Gl& gl, GLuint buffer, std::size_t bytes, const void* data, GLenum usage) {
  if (data) gl.traffic->given += bytes;
  gl.NamedBufferData(buffer, GLsizeiptr(bytes), data, usage);
}

void give_buffer_part(const Gl& gl, GLuint buffer, std::size_t offset, std::size_t bytes, const void* data) {
  gl.traffic->given += bytes;
  gl.NamedBufferSubData(buffer, GLintptr(offset), GLsizeiptr(bytes), data);
}

void give_image(const Gl& gl, GLuint texture, int level, const GlRegion& r, GLenum format, GLenum type,
                const void* texels) {
  const int layers = r.layers > 0 ? r.layers : 1;
  gl.traffic->given += std::size_t(r.width) * std::size_t(r.height) * std::size_t(layers) * bytes_of_pixel(format, type);
  if (r.layers > 0) {
    gl.TextureSubImage3D(texture, level, r.x, r.y, r.layer, r.width, r.height, r.layers, format, type, texels);
  } else {
    gl.TextureSubImage2D(texture, level, r.x, r.y, r.width, r.height, format, type, texels);
  }
}

void take_pixels(const Gl& gl, int width, int height, GLenum format, GLenum type, void* pixels) {
  count_wait(gl);
  gl.traffic->taken += std::size_t(width) * std::size_t(height) * bytes_of_pixel(format, type);
  gl.ReadPixels(0, 0, width, height, format, type, pixels);
}

void take_image(const Gl& gl, GLuint texture, GLenum format, GLenum type, std::size_t bytes, void* texels) {
  count_wait(gl);
  gl.traffic->taken += bytes;
  gl.GetTextureImage(texture, 0, format, type, GLsizei(bytes), texels);
}

}  // namespace rubble
