// What goes to the graphics card and comes back, counted: all transfers of render/devices/gl go through these functions.
// Internal to render/.
#pragma once

#include <cstddef>

#include "render/gl/gl.h"

namespace rubble {

// Data for a buffer, in place of what it held.
void give_buffer(const Gl& gl, GLuint buffer, std::size_t bytes, const void* data, GLenum usage);
void give_buffer_part(const Gl& gl, GLuint buffer, std::size_t offset, std::size_t bytes, const void* data);

struct GlRegion {
  int x = 0, y = 0, layer = 0;
  int width = 0, height = 0, layers = 0;  // layers: 0: of a texture without
};
void give_image(const Gl& gl, GLuint texture, int level, const GlRegion& region, GLenum format, GLenum type,
                const void* texels);

// These wait until the card has done all that was asked of it before.
void take_pixels(const Gl& gl, int width, int height, GLenum format, GLenum type, void* pixels);  // of what is bound to read
void take_image(const Gl& gl, GLuint texture, GLenum format, GLenum type, std::size_t bytes, void* texels);

std::size_t bytes_of_pixel(GLenum format, GLenum type);

}  // namespace rubble
