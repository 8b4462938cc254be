#include "render/devices/gl/gl_geometry.h"

#include <algorithm>
#include <string>
#include <type_traits>

#include "kernel/base/error.h"
#include "render/gl/gl_traffic.h"
#include "render/materials/paint_layers.h"

namespace rubble {

namespace {

GlTexture upload_paint_images(const Gl& gl, const PaintLayers& paints) {
  GlTexture texture(gl, GLenum(GL_TEXTURE_2D_ARRAY));
  const TextureStack& images = paints.images;
  const int count = std::max(1, paints.image_count);
  gl.TextureStorage3D(texture.name(), images.levels(), GL_RGBA8, images.size(), images.size(), count);
  for (int i = 0; i < paints.image_count; ++i)
    for (int level = 0; level < images.levels(); ++level)
      give_image(gl, texture.name(), level, {0, 0, i, images.size() >> level, images.size() >> level, 1}, GL_RGBA,
                 GL_UNSIGNED_BYTE, images.texels(i, level).data());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the images of meshes");
  return texture;
}

}  // namespace

GlGeometry::GlGeometry(const Gl& of, const PreparedScene& scene, SceneTables made, const LightTable& at)
    : gl(of), tables(std::move(made)), light(of) {
  static_assert(sizeof(BakedLight) == 8, "shaders read it as two 32-bit words");
  vertices = make_buffer(gl, tables.vertices);
  indices = make_buffer(gl, tables.indices);
  triangles = make_buffer(gl, tables.triangles);
  placed = make_buffer(gl, tables.placed);
  light.give(at);
  vertices_view = make_buffer_texture(gl, vertices, GL_RGBA32UI);
  triangles_view = make_buffer_texture(gl, triangles, GL_RGBA32UI);
  placed_view = make_buffer_texture(gl, placed, GL_RGBA32UI);
  light_view = make_buffer_texture(gl, light.buffer(), GL_RG32UI);
  if (scene.paints) {
    paint = make_buffer(gl, tables.paint);
    paint_view = make_buffer_texture(gl, paint, GL_RGBA32UI);
    paint_images = upload_paint_images(gl, *scene.paints);
  }
  check_gl(gl, "uploading the scene's geometry");
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  const std::size_t need = std::max({tables.vertices.size(), tables.triangles.size(), tables.placed.size(), at.size(),
                                     tables.paint.size()});
  if (need > std::size_t(most))
    throw RunError("the scene needs tables of " + std::to_string(need) + " entries; this graphics device holds " +
                   std::to_string(most) + "; draw it with the software device");
  const auto free_list = [](auto& list) { std::decay_t<decltype(list)>().swap(list); };  // "= {}" would keep its memory
  free_list(tables.vertices), free_list(tables.triangles), free_list(tables.paint), free_list(tables.indices);
}

void GlGeometry::place(const PreparedScene& scene) {
  tables.place(scene);
  give_buffer(gl, placed.name(), tables.placed.size() * sizeof tables.placed[0], tables.placed.data(), GL_STREAM_DRAW);
  check_gl(gl, "moving the pieces");
}

void GlGeometry::set_light(const LightTable& from, const std::vector<LightRange>* changed) {
  ++light_version;
  if (!changed || light.size() != from.size() * sizeof(BakedLight)) {
    light.give(from);
  } else {
    for (const LightRange& range : *changed)
      light.give_part(from.data(), range.begin * sizeof(BakedLight), range.end * sizeof(BakedLight));
  }
  check_gl(gl, "handing the light over");
}

}  // namespace rubble
