#include "render/transport/surface_model.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "render/materials/glass.h"
#include "render/materials/surface_appearance.h"
#include "render/transport/paint_point.h"

namespace rubble {

namespace {

constexpr float kWaterReflectance = 0.02f;  // of refractive index 1.33
constexpr float kFilmRoughness = 0.12f;     // of water on grit, our choice

Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Vec3f mix(const Vec3f& a, const Vec3f& b, float t) { return a + (b - a) * t; }
float fract(float x) { return x - std::floor(x); }
float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}
// From and to axes in which the longest comes first.
Vec3f turned(const Vec3f& v, int turn) {
  return turn == 1 ? Vec3f(v.y, v.z, v.x) : turn == 2 ? Vec3f(v.z, v.x, v.y) : v;
}
Vec3f turned_back(const Vec3f& v, int turn) {
  return turn == 1 ? Vec3f(v.z, v.x, v.y) : turn == 2 ? Vec3f(v.y, v.z, v.x) : v;
}
Vec3f dust_albedo(float bright) { return Vec3f(0.375f, 0.36f, 0.335f) * (0.55f + 0.75f * bright); }
float zigzag(float x) { return std::fabs(fract(x) - 0.5f); }
float ragged(float x, float y) {  // as in render/shading/find_surface.h
  return 0.14f * zigzag(x * 23 + y * 11) + 0.09f * zigzag(y * 61 - x * 29) + 0.03f * zigzag(x * 127 + y * 71) - 0.065f;
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
  bool soil;
  Vec3f point, face, smooth;  // in the mesh; the normals are unit
  Vec3f world;
  Vec3f bent;                  // normal with relief, in the mesh
  float debris, slow;          // of the ground's map: cover, and tone from -2 to 2
  float bright, mask, up;      // of the texture, and Z of the smooth normal in the world
  float raised;                // out of water: bright, in a street against the mean about it
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
  out.warm = (float(piece.look_seed[1] >> 24) * kByte - 1) * 0.25f;
  return out;
}

// Between texels, as GL_LINEAR does.
void LookSurfaces::read_ground(const Vec3f& world, float& debris, float& tone) const {
  constexpr int kSide = GroundMap::kSide;
  const float ax = (world.x + 0.6f * world.z - ground_.x) / ground_.reach;
  const float ay = (world.y + 0.6f * world.z - ground_.y) / ground_.reach;
  const auto at = [](float a) {
    return std::clamp((0.5f + 0.5f * a / (1 + std::fabs(a))) * kSide - 0.5f, 0.0f, kSide - 1.001f);
  };
  const float x = at(ax), y = at(ay), a = x - std::floor(x), b = y - std::floor(y);
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
  place.soil = place.look->pattern == Pattern::soil;
  place.face = normalized(cross(b.position - a.position, c.position - a.position));
  place.point = a.position * w + b.position * query.u + c.position * query.v;
  place.smooth = normalized(a.normal * w + b.normal * query.u + c.normal * query.v +
                            place.face * 0.001f);
  place.world = place.piece->origin + place.to_world(place.point) * place.piece->scale;
  float tone = 0;
  read_ground(place.world, place.debris, tone);
  place.slow = 4 * tone - 2;
}

// The look on the one of 26 planes that the surface is nearest to, with its relief.
void LookSurfaces::find_pattern(const SurfaceQuery& query, Place& place) const {
  const Placed& piece = *place.piece;
  const SurfaceAppearance& look = *place.look;
  const Vec3f q = turned(place.point * piece.scale + piece.in_body, piece.turn);
  const Vec3f f = turned(place.smooth, piece.turn) + Vec3f(ragged(q.x, q.y), ragged(q.y, q.z), ragged(q.z, q.x));
  const auto nearest = [](float x) { return std::floor(x * 1.2f + 0.5f); };
  const Vec3f plane = normalized(Vec3f(nearest(f.x), nearest(f.y), nearest(f.z)));
  const Vec3f along = std::fabs(plane.z) > 0.9f ? Vec3f(1, 0, 0)
                                                : normalized(Vec3f(-plane.y, plane.x, 0));
  const Vec3f across = cross(plane, along);
  float u = dot(q, along) / look.tile + piece.seed_u, v = dot(q, across) / look.tile + piece.seed_v;
  if (look.pattern == Pattern::cast_concrete)
    u += 0.37f * std::floor(v) + 0.21f * std::floor(v * 0.5f);
  const float grazing = std::max(-dot(place.to_world(place.face), query.direction), 0.05f);
  const float texels = float(textures_.size()) / look.tile * query.footprint / std::sqrt(grazing);
  const float level = texels > 1 ? std::log2(texels) : 0;
  auto texel = textures_.read(int(look.pattern), u, v, level);
  if (look.dust < 0.2f && place.slow > -0.6f) {  // as in shaders/surface.glsl
    auto other = textures_.read(int(look.pattern), v * 0.83f + 0.37f, u * 0.83f + 0.37f, level);
    std::swap(other[0], other[1]);
    const float share = smoothstep(-0.15f, 0.15f, place.slow - 0.15f + 0.6f * (other[2] - texel[2]));
    for (std::size_t i = 0; i < texel.size(); ++i) texel[i] += (other[i] - texel[i]) * share;
  }
  const Vec3f tu = turned_back(along, piece.turn), tv = turned_back(across, piece.turn);
  place.bent = place.smooth - tu * ((texel[0] * 4 - 2) * look.bump) -
               tv * ((texel[1] * 4 - 2) * look.bump);
  place.bright = place.raised = texel[2], place.mask = texel[3];
  if (scene_.surrounded && wetness_ > 0)
    place.raised += 0.5f - textures_.read(int(look.pattern), u, v,
                                          std::max(level, std::log2(float(textures_.size())) - 3))[2];
  place.up = place.to_world(place.smooth).z;
}

void LookSurfaces::add_colour(const SurfaceQuery& query, const Place& place, SurfacePoint& out) const {
  const SurfaceAppearance& look = *place.look;
  const float bright = place.bright;
  // On the ground the mask ranks crumbs: the more debris, the more of them lie there, and dust.
  const float crumbs = smoothstep(0, 0.12f, place.mask - 1 + 0.05f + 0.75f * place.debris);
  Vec3f albedo = mix(mix(look.dark, look.light, bright),
                     look.accent * (place.soil ? 0.55f + 0.7f * bright : 1.0f),
                     place.soil ? crumbs : place.mask);
  albedo *= 1 + (place.soil ? 0.3f : 0.16f) * place.slow;
  const float tint = place.piece->tint * look.variation, warm = place.piece->warm * look.variation;
  albedo = times(albedo, Vec3f(1 + warm, 1, 1 - warm)) * (1 + tint);
  if (look.glow > 0)
    out.glow = albedo * (look.glow / dot(look.light, Vec3f(0.2126f, 0.7152f, 0.0722f)));
  const float dust = smoothstep(0.30f, 1.05f, place.up + (bright - 0.45f) * 0.8f) *
                     (place.soil ? 0.85f * place.debris : look.dust);
  albedo = mix(albedo, dust_albedo(bright), dust);
  const Vec3f white(1, 1, 1);
  out.reflection.base = min(max(albedo, Vec3f()), white);
  out.reflection.gloss = {look.reflectance > 0 ? 1 - dust : 0, look.reflectance, look.roughness};
  out.reflection.film = MirrorLayer();
  if (look.name == std::string_view(kGlassAppearance)) add_glass(query, dust, place, out);
}

// Dust and dirt lie on a part of it and are matt; the rest is clear, and mirrors as its angle says. As layers: a
// mirror that covers as much as is mirrored, over a base as bright as makes what the dust throws back.
void LookSurfaces::add_glass(const SurfaceQuery& query, float dust, const Place& place, SurfacePoint& out) const {
  dust *= kGlassDust;
  const float covered = dust + (1 - dust) * (kHazeLeast + kHazeMore * place.bright);
  const SheetShares sheet = find_sheet_shares(-dot(out.face_normal, query.direction));
  const float mirrored = (1 - covered) * sheet.mirrored;
  out.reflection.base = dust_albedo(place.bright) * (covered / (1 - mirrored));
  out.reflection.gloss = {mirrored, 1, place.look->roughness};
  out.passed = sheet.passed * (1 - covered);
}

// Water darkens what it soaks into, and stands as a film on what faces up.
void LookSurfaces::add_water(const Place& place, SurfacePoint& out) const {
  const float wet = wetness_ * smoothstep(-0.6f, 0.5f, place.up + 0.5f * place.slow);
  out.reflection.base *= 1 - 0.5f * wet;
  const float even = smoothstep(0.75f, 0.25f, place.raised);
  const float film = wet * (0.35f + 0.65f * smoothstep(0.2f, 0.9f, place.up)) * even;
  out.reflection.film = {film, kWaterReflectance, kFilmRoughness};
  out.reflection.gloss.cover *= 1 - film;
  out.normal = normalized(mix(out.normal, place.to_world(place.smooth), 0.6f * wet * even));
}

void LookSurfaces::add_paint(const SurfaceQuery& query, const TrianglePaint& paint, const Place& place,
                             SurfacePoint& out) const {
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
  out.reflection.base = found.albedo * (1 - found.metalness);
  out.reflection.gloss = {found.reflectance > 0 ? 1.0f : 0.0f, found.reflectance, found.roughness};
}

void LookSurfaces::find(const SurfaceQuery& query, SurfacePoint& out) const {
  Place place;
  find_place(query, place);
  find_pattern(query, place);
  out.position = place.world;
  out.face_normal = place.to_world(place.face);
  out.normal = normalized(place.to_world(place.bent));
  out.emission = out.glow = out.passed = Vec3f();
  add_colour(query, place, out);
  const PreparedMesh& mesh = scene_.meshes[scene_.placed[query.triangle.placed].mesh];
  if (!mesh.paint.empty() && mesh.paint[query.triangle.source].paint >= 0)
    add_paint(query, mesh.paint[query.triangle.source], place, out);
  if (wetness_ > 0) add_water(place, out);
}

}  // namespace rubble
