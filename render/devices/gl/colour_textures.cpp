#include "render/devices/gl/colour_textures.h"

#include <cmath>

#include "kernel/base/quick_math.h"
#include "render/gl/gl_traffic.h"

namespace rubble {

GlTexture upload_surface_appearances(const Gl& gl, const std::vector<PatternImage>& patterns) {
  const int size = patterns.front().size;
  GlTexture texture(gl, GLenum(GL_TEXTURE_2D_ARRAY));
  const int levels = int(std::lround(quick::log2(double(size)))) + 1;
  gl.TextureStorage3D(texture.name(), levels, GL_RGBA8, size, size, GLsizei(patterns.size()));
  for (std::size_t i = 0; i < patterns.size(); ++i)
    give_image(gl, texture.name(), 0, {0, 0, int(i), size, size, 1}, GL_RGBA, GL_UNSIGNED_BYTE, patterns[i].texels.data());
  gl.GenerateTextureMipmap(texture.name());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the textures");
  return texture;
}

GlTexture upload_sky(const Gl& gl, const Sky& sky) {
  GlTexture texture = make_target(gl, GL_RGB32F, sky.side, sky.side);
  give_image(gl, texture.name(), 0, {0, 0, 0, sky.side, sky.side}, GL_RGB, GL_FLOAT, sky.map.data());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the sky");
  return texture;
}

GlTexture upload_ground(const Gl& gl, const GroundMap& ground) {
  GlTexture texture = make_target(gl, GL_RG8, GroundMap::kSide, GroundMap::kSide);
  give_image(gl, texture.name(), 0, {0, 0, 0, GroundMap::kSide, GroundMap::kSide}, GL_RG, GL_UNSIGNED_BYTE,
             ground.texels.data());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the map of the ground");
  return texture;
}

}  // namespace rubble
