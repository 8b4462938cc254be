#include "render/geometry/geometry.h"

#include <algorithm>
#include <cstring>

#include "kernel/base/error.h"
#include "kernel/base/parallel.h"
#include "kernel/base/random.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

int find_longest_axis(const PreparedMesh& mesh) {
  Vec3f low = mesh.vertices.front().position, high = low;
  for (const PreparedVertex& v : mesh.vertices)
    low = min(low, v.position), high = max(high, v.position);
  return longest_axis(high - low);
}

void place(PreparedScene& out, PlacedMesh piece, std::uint32_t axis, RandomStream& random) {
  const PreparedMesh& mesh = out.meshes[piece.mesh];
  piece.centre = Vec3f(piece.world_from_mesh * (Vec3(mesh.centre) * piece.scale));
  piece.radius = float(mesh.radius * piece.scale);
  piece.first_flag = std::uint32_t(out.cluster_flags);
  piece.first_light = std::uint32_t(out.light_nodes);
  const std::uint32_t start = std::uint32_t(random.next() >> 32), tone = std::uint32_t(random.next() >> 32);
  piece.look_seed = {start, (tone & 0xffff0000u) | axis};
  out.cluster_flags += mesh.levels.front().cluster_count;
  out.light_nodes += mesh.light_nodes.size();
  out.glass = out.glass || mesh.glass;
  if (piece.id != kGroundId && !piece.moves && !piece.surrounds) {
    const Vec3 reach = Vec3(1, 1, 1) * double(piece.radius);
    out.bounds.include(Vec3(piece.centre) - reach);
    out.bounds.include(Vec3(piece.centre) + reach);
  }
  out.placed.push_back(piece);
}

std::uint32_t float_bits(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

// Octahedral normal in two 16-bit signed parts (Cigolle et al. 2014).
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

// A place in a body: X and Y from -32 m by steps of 1/1024 m, Z from -2 m by steps of 1/256 m. They begin anew
// after 64 and 32 m, where textures then have a seam.
std::array<std::uint32_t, 2> pack_cut(const CutFrom& cut, std::uint64_t seed) {
  const auto steps = [](double x, double least, double a_metre, std::uint32_t mask) {
    return std::uint32_t(std::int64_t(std::floor((x - least) * a_metre + 0.5))) & mask;
  };
  RandomStream random(seed, "render.bodies." + std::to_string(cut.body));
  const std::uint32_t tone = std::uint32_t(random.next() >> 32) & 0xffff0000u;
  return {steps(cut.origin.x, -32, 1024, 0xffff) | steps(cut.origin.y, -32, 1024, 0xffff) << 16,
          tone | steps(cut.origin.z, -2, 256, 0x1fff) << 3 | 4u | std::uint32_t(cut.grain)};
}

using Texel = GpuGeometry::Texel;

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

// What moves reaches as far as its origin does, and its mesh about that.
void include_motion(const Scene& scene, PreparedScene& out) {
  if (scene.motion.moving.empty() || scene.motion.reach.empty()) return;
  double most = 0;  // of a mesh's point from its origin
  for (const std::uint32_t i : scene.motion.moving) {
    const PlacedMesh& piece = out.placed[i];
    const PreparedMesh& mesh = out.meshes[piece.mesh];
    most = std::max(most, (double(norm(mesh.centre)) + double(mesh.radius)) * piece.scale);
  }
  const Vec3 margin = Vec3(1, 1, 1) * most;
  out.bounds.include(scene.motion.reach.min - margin);
  out.bounds.include(scene.motion.reach.max + margin);
}

void mark_moving(const Scene& scene, std::vector<std::uint8_t>& moves) {
  moves.assign(scene.instances.size(), 0);
  for (const std::uint32_t i : scene.motion.moving) {
    if (i >= moves.size())
      throw RunError("the motion of the scene refers to instance " + std::to_string(i) + " of " +
                     std::to_string(moves.size()));
    moves[i] = 1;
  }
}

// Each paint once, however many meshes have it.
void number_paints(PreparedScene& scene) {
  std::vector<std::shared_ptr<const SurfacePaint>> all;
  for (PreparedMesh& mesh : scene.meshes) {
    std::vector<std::int32_t> numbers;
    for (const auto& paint : mesh.paints) {
      const auto found =
          std::find_if(all.begin(), all.end(), [&](const auto& p) { return p->sha256 == paint->sha256; });
      numbers.push_back(std::int32_t(found - all.begin()));
      if (found == all.end()) all.push_back(paint), scene.paint_key += paint->sha256;
    }
    for (TrianglePaint& triangle : mesh.paint)
      if (triangle.paint >= 0) triangle.paint = numbers[std::size_t(triangle.paint)];
  }
  if (!all.empty()) scene.paints = std::make_shared<const PaintLayers>(make_paint_layers(all));
}

}  // namespace

PreparedScene prepare_scene(const Scene& scene, int threads) {
  PreparedScene out;
  out.meshes.resize(scene.meshes.size());
  parallel_for(scene.meshes.size(), threads, [&](std::size_t i) {
    if (!scene.meshes[i]) throw RunError("the scene has a mesh without data");
    out.meshes[i] = prepare_mesh(*scene.meshes[i]);
  });
  number_paints(out);
  std::vector<std::uint32_t> axes;
  for (const PreparedMesh& mesh : out.meshes) axes.push_back(std::uint32_t(find_longest_axis(mesh)));
  std::vector<std::uint8_t> moves;
  mark_moving(scene, moves);
  RandomStream random(scene.seed, "render.looks");
  for (const SceneInstance& instance : scene.instances) {
    if (instance.mesh >= out.meshes.size())
      throw RunError("an instance of the scene refers to mesh " + std::to_string(instance.mesh) +
                     " of " + std::to_string(out.meshes.size()));
    PlacedMesh piece;
    piece.mesh = instance.mesh;
    piece.scale = double(instance.scale);
    piece.world_from_mesh = instance.world_from_body;
    piece.id = instance.id;
    piece.label = instance.label;
    piece.moves = moves[out.placed.size()];
    piece.surrounds = instance.surrounds;
    out.surrounded = out.surrounded || piece.surrounds;
    // Courses of walls lie level, however high or deep a building is.
    place(out, piece, piece.surrounds ? 0 : axes[instance.mesh], random);
    if (instance.cut_from.body) out.placed.back().look_seed = pack_cut(instance.cut_from, scene.seed);
  }
  include_motion(scene, out);
  if (scene.ground) {
    out.meshes.push_back(prepare_ground(out.bounds));
    PlacedMesh ground;
    ground.mesh = std::uint32_t(out.meshes.size() - 1);
    ground.id = kGroundId;
    ground.label = kGroundLabel;
    place(out, ground, 0, random);
  }
  return out;
}

PreparedScene resting_part(const PreparedScene& scene, std::vector<std::uint32_t>& first_light) {
  PreparedScene out;
  out.meshes = scene.meshes;
  out.paints = scene.paints, out.paint_key = scene.paint_key;
  for (const PlacedMesh& piece : scene.placed) {
    if (piece.moves) continue;
    first_light.push_back(piece.first_light);
    out.placed.push_back(piece);
    out.placed.back().first_flag = std::uint32_t(out.cluster_flags);
    out.placed.back().first_light = std::uint32_t(out.light_nodes);
    out.cluster_flags += scene.meshes[piece.mesh].levels.front().cluster_count;
    out.light_nodes += scene.meshes[piece.mesh].light_nodes.size();
    out.glass = out.glass || scene.meshes[piece.mesh].glass;
    if (piece.id == kGroundId || piece.surrounds) continue;
    const Vec3 reach = Vec3(1, 1, 1) * double(piece.radius);
    out.bounds.include(Vec3(piece.centre) - reach);
    out.bounds.include(Vec3(piece.centre) + reach);
  }
  return out;
}

namespace {

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
std::vector<Texel> make_paint_table(const PreparedScene& scene, const GpuGeometry& geometry,
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
      const std::uint32_t name = geometry.name_of_triangle[geometry.first_index[m] / 3 + t];
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

GlTexture upload_images(const Gl& gl, const PaintLayers& paints) {
  GlTexture texture(gl, GLenum(GL_TEXTURE_2D_ARRAY));
  const TextureStack& images = paints.images;
  const int count = std::max(1, paints.image_count);
  gl.TextureStorage3D(texture.name(), images.levels(), GL_RGBA8, images.size(), images.size(), count);
  for (int i = 0; i < paints.image_count; ++i)
    for (int level = 0; level < images.levels(); ++level)
      gl.TextureSubImage3D(texture.name(), level, 0, 0, i, images.size() >> level, images.size() >> level, 1,
                           GL_RGBA, GL_UNSIGNED_BYTE, images.texels(i, level).data());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the images of meshes");
  return texture;
}

// The number of entries of the table.
std::size_t upload_paint(const Gl& gl, const PreparedScene& scene, const std::vector<Texel>& triangles,
                         GpuGeometry& out) {
  if (!scene.paints) return 0;
  const std::vector<Texel> table = make_paint_table(scene, out, triangles);
  out.paint = make_buffer(gl, table);
  out.paint_view = make_buffer_texture(gl, out.paint, GL_RGBA32UI);
  out.paint_images = upload_images(gl, *scene.paints);
  out.paint_count = scene.paints->paints.size();
  out.paint_side = scene.paints->images.size();
  if (out.on_processor) out.tables.paint = table;
  return table.size();
}

}  // namespace

GpuGeometry upload_geometry(const Gl& gl, const PreparedScene& scene,
                            const std::vector<BakedLight>& light, bool on_processor) {
  static_assert(sizeof(BakedLight) == 8, "shaders read it as two 32-bit words");
  GpuGeometry out;
  out.on_processor = on_processor;
  std::vector<Texel> vertices, triangles, placed;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t>& first_vertex = out.first_vertex;
  for (const PreparedMesh& mesh : scene.meshes) {
    first_vertex.push_back(std::uint32_t(vertices.size()));
    for (const PreparedVertex& v : mesh.vertices)
      vertices.push_back({float_bits(v.position.x), float_bits(v.position.y),
                          float_bits(v.position.z), pack_normal(v.normal)});
  }
  TriangleNamer namer(vertices, triangles);
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    out.first_index.push_back(std::uint32_t(indices.size()));
    for (const PreparedTriangle& t : scene.meshes[m].triangles) {
      const auto& i = t.vertices;
      const std::uint32_t base = first_vertex[m];
      const auto named = namer.name({base + i[0], base + i[1], base + i[2]}, look_word(t, base));
      indices.insert(indices.end(), named.begin(), named.end());
      out.name_of_triangle.push_back(named[2]);
    }
  }
  out.triangle_of_name.resize(vertices.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    for (std::uint32_t t = 0; t < scene.meshes[m].triangles.size(); ++t)
      out.triangle_of_name[out.name_of_triangle[out.first_index[m] / 3 + t]] = t;
  for (const PlacedMesh& piece : scene.placed)
    append_placed(piece, first_vertex[piece.mesh], placed);
  out.vertices = make_buffer(gl, vertices);
  out.indices = make_buffer(gl, indices);
  out.triangles = make_buffer(gl, triangles);
  out.placed = make_buffer(gl, placed);
  out.light = make_buffer(gl, on_processor ? std::vector<BakedLight>(1) : light);
  out.vertices_view = make_buffer_texture(gl, out.vertices, GL_RGBA32UI);
  out.triangles_view = make_buffer_texture(gl, out.triangles, GL_RGBA32UI);
  out.placed_view = make_buffer_texture(gl, out.placed, GL_RGBA32UI);
  out.light_view = make_buffer_texture(gl, out.light, GL_RG32UI);
  const std::size_t painted = upload_paint(gl, scene, triangles, out);
  check_gl(gl, "uploading the scene's geometry");
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  const std::size_t need =
      std::max({vertices.size(), triangles.size(), placed.size(), light.size(), painted});
  if (need > std::size_t(most))
    throw RunError("the scene needs tables of " + std::to_string(need) +
                   " entries; this graphics device holds " + std::to_string(most));
  if (on_processor) {
    out.tables.vertices = std::move(vertices), out.tables.triangles = std::move(triangles);
    out.tables.placed = std::move(placed);
  }
  return out;
}

void update_poses(const Gl& gl, const PreparedScene& scene, GpuGeometry& geometry) {
  std::vector<Texel> placed;
  for (const PlacedMesh& piece : scene.placed)
    append_placed(piece, geometry.first_vertex[piece.mesh], placed);
  gl.NamedBufferData(geometry.placed.name(), GLsizeiptr(placed.size() * sizeof(Texel)),
                     placed.data(), GL_STREAM_DRAW);
  check_gl(gl, "moving the pieces");
  if (geometry.on_processor) geometry.tables.placed = std::move(placed);
}

void update_light(const Gl& gl, const GpuGeometry& geometry, const std::vector<BakedLight>& light) {
  if (geometry.on_processor) return;  // it reads them where they are
  gl.NamedBufferData(geometry.light.name(), GLsizeiptr(light.size() * sizeof(BakedLight)),
                     light.data(), GL_STREAM_DRAW);
  check_gl(gl, "handing the light over");
}

void update_light(const Gl& gl, const GpuGeometry& geometry, const std::vector<BakedLight>& light,
                  const std::vector<LightRange>& changed) {
  if (geometry.on_processor) return;
  for (const LightRange& range : changed)
    gl.NamedBufferSubData(geometry.light.name(), GLintptr(range.begin * sizeof(BakedLight)),
                          GLsizeiptr((range.end - range.begin) * sizeof(BakedLight)), light.data() + range.begin);
  check_gl(gl, "handing over some of the light");
}

}  // namespace rubble
