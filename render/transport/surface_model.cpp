#include "render/transport/surface_model.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "kernel/base/quick_math.h"
#include "render/materials/glass.h"
#include "render/materials/surface_appearance.h"
#include "render/surface/scalar_surface.h"
#include "render/transport/paint_point.h"

namespace rubble {

using scalar::SurfaceDetail, scalar::SurfaceLayers;

namespace {

// From and to axes in which the longest comes first.
Vec3f turned(const Vec3f& v, int turn) {
  return turn == 1 ? Vec3f(v.y, v.z, v.x) : turn == 2 ? Vec3f(v.z, v.x, v.y) : v;
}
Vec3f turned_back(const Vec3f& v, int turn) {
  return turn == 1 ? Vec3f(v.z, v.x, v.y) : turn == 2 ? Vec3f(v.y, v.z, v.x) : v;
}

}  // namespace

SurfacePoint find_flat_point(const PreparedScene& scene, const SurfaceQuery& query) {
  const PlacedMesh& piece = scene.placed[query.triangle.placed];
  const PreparedMesh& mesh = scene.meshes[piece.mesh];
  Vec3 p[3];
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = piece.world_from_mesh *
           (Vec3(mesh.vertices[mesh.triangles[query.triangle.source].vertices[i]].position) * piece.scale);
  SurfacePoint out;
  out.position = Vec3f(p[0] + (p[1] - p[0]) * double(query.u) + (p[2] - p[0]) * double(query.v));
  out.face_normal = out.normal = Vec3f(normalized(cross(p[1] - p[0], p[2] - p[0])));
  return out;
}

struct LookSurfaces::Place {
  const Placed* piece;
  const SurfaceAppearance* look;
  Vec3f point, face, smooth;  // in the mesh; the normals are unit
  Vec3f world;
  Vec3f bent;                  // normal with relief, in the mesh
  SurfaceDetail detail;
  Vec3f to_world(const Vec3f& v) const {
    return piece->axis_x * v.x + piece->axis_y * v.y + piece->axis_z * v.z;
  }
};

LookSurfaces::LookSurfaces(const PreparedScene& scene, const std::vector<PatternImage>& patterns,
                           const GroundMap& ground, double wetness)
    : scene_(scene), textures_(patterns), ground_(ground), wetness_(float(wetness)) {
  for (const PlacedMesh& piece : scene.placed) placed_.push_back(place(piece));
}

void LookSurfaces::follow() {
  for (std::size_t i = 0; i < placed_.size(); ++i)
    if (scene_.placed[i].moves) placed_[i] = place(scene_.placed[i]);
}

LookSurfaces::Placed LookSurfaces::place(const PlacedMesh& piece) const {
  const Mat3 r = piece.world_from_mesh.rotation.matrix();
  constexpr float kByte = 2.0f / 255;
  Placed out;
  out.axis_x = Vec3f(r.column(0)), out.axis_y = Vec3f(r.column(1)), out.axis_z = Vec3f(r.column(2));
  out.origin = Vec3f(piece.world_from_mesh.translation);
  out.scale = float(piece.scale);
  const float u = float(piece.look_seed[0] & 0xffffu), v = float(piece.look_seed[0] >> 16);
  if (piece.look_seed[1] & 4u)
    out.in_body = {u / 1024 - 32, v / 1024 - 32, float(piece.look_seed[1] >> 3 & 0x1fffu) / 256 - 2};
  else
    out.seed_u = u / 65536, out.seed_v = v / 65536;
  out.turn = int(piece.look_seed[1] & 3u);
  out.tint = float(piece.look_seed[1] >> 16 & 255u) * kByte - 1;
  out.warm = float(piece.look_seed[1] >> 24) * kByte - 1;
  return out;
}

// Between texels, as GL_LINEAR does.
void LookSurfaces::read_ground(const Vec3f& world, float& debris, float& tone) const {
  constexpr int kSide = GroundMap::kSide;
  const auto at = [&](float along, float middle) {
    const float place = scalar::map_place(along, world.z, middle, 1 / ground_.reach);
    return std::clamp(place * kSide - 0.5f, 0.0f, kSide - 1.001f);
  };
  const float x = at(world.x, ground_.x), y = at(world.y, ground_.y), a = x - std::floor(x), b = y - std::floor(y);
  const std::uint8_t* p = &ground_.texels[(std::size_t(int(y)) * kSide + std::size_t(int(x))) * 2];
  const auto value = [&](int channel) {
    const float top = float(p[channel]) * (1 - a) + float(p[2 + channel]) * a;
    const float bottom =
        float(p[2 * kSide + channel]) * (1 - a) + float(p[2 * kSide + 2 + channel]) * a;
    return (top * (1 - b) + bottom * b) * (1.0f / 255);
  };
  debris = value(0), tone = value(1);
}

void LookSurfaces::find_place(const SurfaceQuery& query, Place& place) const {
  const PlacedMesh& piece = scene_.placed[query.triangle.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const PreparedTriangle& triangle = mesh.triangles[query.triangle.source];
  const PreparedVertex& a = mesh.vertices[triangle.vertices[0]];
  const PreparedVertex& b = mesh.vertices[triangle.vertices[1]];
  const PreparedVertex& c = mesh.vertices[triangle.vertices[2]];
  const float w = 1 - query.u - query.v;
  place.piece = &placed_[query.triangle.placed];
  place.look = &all_surface_appearances()[triangle.material];
  place.detail.soil = place.look->pattern == Pattern::soil;
  place.face = normalized(cross(b.position - a.position, c.position - a.position));
  place.point = a.position * w + b.position * query.u + c.position * query.v;
  place.smooth = normalized(a.normal * w + b.normal * query.u + c.normal * query.v +
                            place.face * 0.001f);
  place.world = place.piece->origin + place.to_world(place.point) * place.piece->scale;
  float tone = 0;
  read_ground(place.world, place.detail.debris, tone);
  place.detail.slow = 4 * tone - 2;
}

// The look on the one of 26 planes that the surface is nearest to, with its relief.
void LookSurfaces::find_pattern(const SurfaceQuery& query, Place& place) const {
  const Placed& piece = *place.piece;
  const SurfaceAppearance& look = *place.look;
  const Vec3f q = turned(place.point * piece.scale + piece.in_body, piece.turn);
  const scalar::TextureAxes axes =
      scalar::find_texture_axes(scalar::real3(q), scalar::real3(turned(place.smooth, piece.turn)));
  const Vec3f along = scalar::to_vec3(axes.along), across = scalar::to_vec3(axes.across);
  float u = dot(q, along) / look.tile + piece.seed_u, v = dot(q, across) / look.tile + piece.seed_v;
  if (look.pattern == Pattern::cast_concrete) u += scalar::wall_shift(v);
  const float grazing = std::max(-dot(place.to_world(place.face), query.direction), 0.05f);
  const float texels = float(textures_.size()) / look.tile * query.footprint / std::sqrt(grazing);
  const float level = texels > 1 ? quick::log2(texels) : 0;
  auto texel = textures_.read(int(look.pattern), u, v, level);
  SurfaceDetail& detail = place.detail;
  if (look.dust < 0.2f && detail.slow > -0.6f) {
    auto other = textures_.read(int(look.pattern), v * 0.83f + 0.37f, u * 0.83f + 0.37f, level);
    std::swap(other[0], other[1]);
    const float share = scalar::other_part(detail.slow, texel[2], other[2]);
    for (std::size_t i = 0; i < texel.size(); ++i) texel[i] += (other[i] - texel[i]) * share;
  }
  const Vec3f tu = turned_back(along, piece.turn), tv = turned_back(across, piece.turn);
  const float bump = look.glow > 0 ? 0 : look.bump;
  place.bent = place.smooth - tu * ((texel[0] * 4 - 2) * bump) - tv * ((texel[1] * 4 - 2) * bump);
  detail.bright = detail.raised = texel[2], detail.mask = texel[3];
  if (scene_.surrounded && wetness_ > 0)
    detail.raised += 0.5f - textures_.read(int(look.pattern), u, v,
                                          std::max(level, quick::log2(float(textures_.size())) - 3))[2];
  detail.up = place.to_world(place.smooth).z;
}

// The paint of a triangle at the point.
void LookSurfaces::add_paint(const SurfaceQuery& query, const TrianglePaint& paint, const Place& place,
                             SurfacePoint& out, SurfaceLayers& layers) const {
  const PreparedMesh& mesh = scene_.meshes[scene_.placed[query.triangle.placed].mesh];
  const PreparedTriangle& triangle = mesh.triangles[query.triangle.source];
  PaintQuery at;
  for (std::size_t i = 0; i < 3; ++i) at.corners[i] = mesh.vertices[triangle.vertices[i]].position;
  at.weights = {1 - query.u - query.v, query.u, query.v};
  at.normal = place.smooth;
  const float grazing = std::max(-dot(out.face_normal, query.direction), 0.05f);
  at.footprint = query.footprint / std::sqrt(grazing) / place.piece->scale;
  const PaintPoint found = find_paint(*scene_.paints, paint, at);
  out.normal = normalized(place.to_world(found.normal));
  layers = scalar::paint_over(layers, scalar::real3(found.albedo), found.roughness, found.metalness, found.reflectance);
}

void LookSurfaces::find(const SurfaceQuery& query, SurfacePoint& out) const {
  Place place;
  find_place(query, place);
  find_pattern(query, place);
  out.position = place.world;
  out.face_normal = place.to_world(place.face);
  out.normal = normalized(place.to_world(place.bent));
  const SurfaceAppearance& look = *place.look;
  const auto colour = [](const Vec3f& c) { return scalar::real3(c); };
  SurfaceLayers layers =
      scalar::find_layers({colour(look.dark), colour(look.light), colour(look.accent), look.dust, look.variation,
                           look.reflectance, std::max(look.roughness, 0.02f), look.glow},
                          place.detail, place.piece->tint, place.piece->warm);
  const PreparedMesh& mesh = scene_.meshes[scene_.placed[query.triangle.placed].mesh];
  if (!mesh.paint.empty() && mesh.paint[query.triangle.source].paint >= 0)
    add_paint(query, mesh.paint[query.triangle.source], place, out, layers);
  if (look.name == std::string_view(kGlassAppearance))
    layers = scalar::make_glass(layers, -dot(out.face_normal, query.direction), place.detail.bright);
  if (wetness_ > 0) {
    const scalar::WetSurface wet = scalar::add_water(layers, place.detail, wetness_);
    layers = wet.layers;
    out.normal = normalized(out.normal * (1 - wet.even) + place.to_world(place.smooth) * wet.even);
  }
  out.emission = Vec3f(), out.glow = scalar::to_vec3(layers.glow), out.passed = scalar::to_vec3(layers.clear);
  out.reflection.base = min(max(scalar::to_vec3(layers.albedo), Vec3f()), Vec3f(1, 1, 1));
  // A mirror that never mirrors is none, and costs nothing.
  out.reflection.gloss = {layers.reflectance > 0 ? layers.cover : 0, layers.reflectance, layers.roughness};
  out.reflection.film = {layers.film, scalar::kWaterReflectance, scalar::kFilmRoughness};
}

}  // namespace rubble
