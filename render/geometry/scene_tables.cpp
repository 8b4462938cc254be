#include "render/geometry/scene_tables.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

std::uint32_t float_bits(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

using Texel = SceneTables::Texel;

void append_placed(const PlacedMesh& piece, std::uint32_t first_vertex, std::vector<Texel>& out) {
  // Rows of mesh_from_world.
  const Pose inverse = piece.world_from_mesh.inverse();
  const Mat3 r = inverse.rotation.matrix() * (1 / piece.scale);
  const Vec3 t = inverse.translation * (1 / piece.scale);
  for (int i = 0; i < 3; ++i)
    out.push_back({float_bits(float(r.rows[i].x)), float_bits(float(r.rows[i].y)),
                   float_bits(float(r.rows[i].z)), float_bits(float(t[i]))});
  out.push_back({float_bits(float(piece.scale)), piece.first_light - first_vertex,
                 piece.look_seed[0], piece.look_seed[1]});
}

// Gives each triangle a last vertex of its own, by which a drawn pixel tells its triangle: cheaper
// than gl_PrimitiveID, for which software drivers leave their fast path. A vertex that is taken is
// copied to the end of the table. Entry v of the triangle table is the triangle whose last vertex
// is v, by its vertices before copying.
class TriangleNamer {
 public:
  TriangleNamer(std::vector<Texel>& vertices, std::vector<Texel>& triangles)
      : vertices_(vertices), triangles_(triangles), taken_(vertices.size(), false) {
    triangles_.assign(vertices.size(), Texel{});
  }

  // look: with how often the corners were turned still to be added, for its grid of light goes by their
  // order in the mesh.
  std::array<std::uint32_t, 3> name(std::array<std::uint32_t, 3> t, std::uint32_t look) {
    std::uint32_t turns = 0;
    for (; turns < 3 && taken_[t[2]]; ++turns) t = {t[1], t[2], t[0]};
    const Texel entry{t[0], t[1], t[2], look + kMaxSurfaceAppearances * (turns % 3)};
    if (taken_[t[2]]) {
      vertices_.push_back(vertices_[t[2]]);
      triangles_.push_back(entry);
      return {t[0], t[1], std::uint32_t(vertices_.size() - 1)};
    }
    taken_[t[2]] = true;
    triangles_[t[2]] = entry;
    return t;
  }

 private:
  std::vector<Texel>& vertices_;
  std::vector<Texel>& triangles_;
  std::vector<bool> taken_;
};

// Its look, and where its light is kept: see shaders/geometry.glsl. Where there is no room for the number
// of its first node it takes the light of its corners.
std::uint32_t look_word(const PreparedTriangle& t, std::uint32_t first_vertex) {
  const std::uint64_t first_node = std::uint64_t(first_vertex) + t.first_node;
  if (t.light_steps < 2 || first_node >> 21) return t.material;
  return t.material + kMaxSurfaceAppearances * 3 * (t.light_steps - 1) + (std::uint32_t(first_node) << 11);
}

Texel pack_floats(float a, float b, float c, float d) {
  return {float_bits(a), float_bits(b), float_bits(c), float_bits(d)};
}

std::uint32_t pack_colour(const Vec3f& c) {
  return std::uint32_t(encode_srgb(c.x)) | std::uint32_t(encode_srgb(c.y)) << 8 | std::uint32_t(encode_srgb(c.z)) << 16;
}

// Two texels a paint, then three a triangle, by its name: see shaders/paint.glsl.
// triangles: their table.
std::vector<Texel> make_paint_table(const PreparedScene& scene, const TriangleNames& names,
                                    const std::vector<Texel>& triangles) {
  std::vector<Texel> out;
  for (const PaintLayers::Paint& p : scene.paints->paints) {
    out.push_back(pack_floats(p.colour.x, p.colour.y, p.colour.z, p.roughness));
    out.push_back(pack_floats(p.metalness, p.reflectance, float(p.albedo), float(p.relief)));
  }
  const std::size_t first = out.size();
  out.resize(first + 3 * triangles.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    for (std::size_t t = 0; t < scene.meshes[m].paint.size(); ++t) {
      const TrianglePaint& paint = scene.meshes[m].paint[t];
      if (paint.paint < 0) continue;
      const std::uint32_t name = names.name(std::uint32_t(m), std::uint32_t(t));
      // By the corners as the table of triangles has them, which may be turned.
      std::array<PaintCorner, 3> c = paint.corners;
      for (std::uint32_t turns = (triangles[name][3] & 2047u) / kMaxSurfaceAppearances % 3; turns > 0; --turns)
        c = {c[1], c[2], c[0]};
      Texel* at = &out[first + 3 * name];
      at[0] = pack_floats(c[0].u, c[0].v, c[1].u, c[1].v);
      at[1] = {float_bits(c[2].u), float_bits(c[2].v), std::uint32_t(paint.paint), 0};
      at[2] = {pack_colour(c[0].colour), pack_colour(c[1].colour), pack_colour(c[2].colour), 0};
    }
  }
  return out;
}

}  // namespace

std::uint32_t pack_normal(const Vec3f& n) {
  const float sum = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
  if (sum == 0) return 0x7fff;
  float u = n.x / sum, v = n.y / sum;
  if (n.z < 0) {
    const float w = (1 - std::fabs(v)) * (u >= 0 ? 1.0f : -1.0f);
    v = (1 - std::fabs(u)) * (v >= 0 ? 1.0f : -1.0f);
    u = w;
  }
  const auto part = [](float x) { return std::uint32_t(std::lround(x * 32767.0f)) & 0xffffu; };
  return part(u) | part(v) << 16;
}

SceneTables make_scene_tables(const PreparedScene& scene) {
  SceneTables out;
  for (const PreparedMesh& mesh : scene.meshes) {
    out.first_vertex.push_back(std::uint32_t(out.vertices.size()));
    for (const PreparedVertex& v : mesh.vertices)
      out.vertices.push_back({float_bits(v.position.x), float_bits(v.position.y),
                              float_bits(v.position.z), pack_normal(v.normal)});
  }
  TriangleNamer namer(out.vertices, out.triangles);
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    out.names.first_triangle.push_back(std::uint32_t(out.indices.size() / 3));
    for (const PreparedTriangle& t : scene.meshes[m].triangles) {
      const auto& i = t.vertices;
      const std::uint32_t base = out.first_vertex[m];
      const auto named = namer.name({base + i[0], base + i[1], base + i[2]}, look_word(t, base));
      out.indices.insert(out.indices.end(), named.begin(), named.end());
      out.names.name_of_triangle.push_back(named[2]);
    }
  }
  out.names.triangle_of_name.resize(out.vertices.size());
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m)
    for (std::uint32_t t = 0; t < scene.meshes[m].triangles.size(); ++t)
      out.names.triangle_of_name[out.names.name(m, t)] = t;
  out.place(scene);
  if (!scene.paints) return out;
  out.paint = make_paint_table(scene, out.names, out.triangles);
  out.paint_count = scene.paints->paints.size();
  out.paint_side = scene.paints->images.size();
  return out;
}

void SceneTables::place(const PreparedScene& scene) {
  placed.clear();
  for (const PlacedMesh& piece : scene.placed) append_placed(piece, first_vertex[piece.mesh], placed);
}

}  // namespace rubble
