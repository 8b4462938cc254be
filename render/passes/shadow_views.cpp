#include "render/passes/shadow_views.h"

#include <algorithm>
#include <cmath>

#include "render/materials/glass.h"

namespace rubble {

namespace {

using Rows = ShadowViews::Rows;

constexpr double kNearest = 0.05;  // unit: m; nothing nearer to a lamp throws a shadow
constexpr double kShadowReach = 500;  // unit: m
constexpr double kWide = 90;  // half a side of the box of surroundings that throw shadows there; unit: m
constexpr double kMostAside = 0.25;  // of the border that a directional view has for penumbras; unit: m
constexpr std::size_t kMostTexels = std::size_t(6) * 2048 * 2048;  // of all views
constexpr std::size_t kMostTexelsAround = std::size_t(2) * 4096 * 4096;  // where there are surroundings

struct Basis {
  Vec3 right, up, forward;
};

Basis basis_along(const Vec3& forward) {
  const Vec3 side = std::fabs(forward.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 right = normalized(cross(forward, side));
  return {right, cross(right, forward), forward};
}

std::array<double, 4> row(const Vec3& v, const Vec3& origin, double scale) {
  return {v.x * scale, v.y * scale, v.z * scale, -dot(v, origin) * scale};
}

// A box along the light around the pieces and what they shade nearby.
// least_depth: half of its length along the light.
Rows directional_view(const Aabb& bounds, const LightModel& light, int size, double least_depth, float& texel) {
  const Basis b = basis_along(Vec3(light.axis));
  const Vec3 middle = (bounds.min + bounds.max) * 0.5;
  double width = 0.1, height = 0.1, depth = least_depth;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                 corner & 4 ? bounds.max.z : bounds.min.z);
    width = std::max(width, std::fabs(dot(p - middle, b.right)));
    height = std::max(height, std::fabs(dot(p - middle, b.up)));
    depth = std::max(depth, std::fabs(dot(p - middle, b.forward)));
  }
  // What stands at the border of the box has its penumbra outside of it.
  const double aside = std::min(double(kSunRadius) * 2 * depth, kMostAside);
  width += aside, height += aside;
  texel = float(2 * std::max(width, height) / size);
  Rows rows{row(b.right, middle, 1 / width),
            row(b.up, middle, 1 / height),
            row(b.forward, middle, 0.5 / (depth * 1.01)),
            {0, 0, 0, 1}};
  rows[2][3] += 0.5;
  // What lies behind the box (the ground in a long shadow) is still compared: see DEPTH_CLAMP.
  return rows;
}

Rows perspective_view(const Vec3& eye, const Basis& b, double tangent) {
  const double a = kShadowReach / (kShadowReach - kNearest), c = -kNearest * a;
  Rows rows{row(b.right, eye, 1 / tangent), row(b.up, eye, 1 / tangent), row(b.forward, eye, a),
            row(b.forward, eye, 1)};
  rows[2][3] += c;
  return rows;
}

std::vector<Rows> make_beam_views(const PreparedScene& scene, const LightModel& light, int size, ShadowViews::Light& out) {
  Aabb bounds = scene.bounds;
  if (bounds.empty()) bounds.include({0, 0, 0});
  // What is nearer to the light than the box would never be in shadow: surroundings stand there.
  const double least = scene.surrounded ? 3 * kWide : 0.1;
  std::vector<Rows> views{directional_view(bounds, light, size, least, out.texel)};
  if (!scene.surrounded) return views;
  const Vec3 middle = (bounds.min + bounds.max) * 0.5;
  bounds.include(Vec3(middle.x - kWide, middle.y - kWide, 0)), bounds.include(Vec3(middle.x + kWide, middle.y + kWide, 25));
  views.push_back(directional_view(bounds, light, size, least, out.far_texel));
  return views;
}

std::vector<Rows> make_views(const PreparedScene& scene, const LightModel& light, int size, ShadowViews::Light& out) {
  float& texel = out.texel;
  if (light.type == LightType::directional) return make_beam_views(scene, light, size, out);
  const Vec3 eye(light.position);
  const bool wide = light.type == LightType::point || light.cos_outer < 0.64f;
  if (!wide) {
    const double c = double(light.cos_outer);
    const double tangent = std::sqrt(1 - c * c) / c * 1.02;
    texel = float(2 * tangent / size);
    return {perspective_view(eye, basis_along(Vec3(light.axis)), tangent)};
  }
  texel = 2.0f / float(size);
  std::vector<Rows> views;
  for (int face = 0; face < 6; ++face) {
    Vec3 forward;
    forward[face / 2] = face % 2 ? -1 : 1;
    views.push_back(perspective_view(eye, basis_along(forward), 1.005));
  }
  return views;
}

// What finding edges must know of a directional view.
EdgeView edge_view(const Rows& rows, int size) {
  EdgeView out;
  Vec3 axes[3];
  double scale[3], middle = 0;  // middle: height of the world's point at the centre of the box
  const double centre[3] = {0, 0, 0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = Vec3(rows[i][0], rows[i][1], rows[i][2]);
    scale[i] = 1 / dot(axes[i], axes[i]);
    middle += axes[i].z * scale[i] * (centre[i] - rows[i][3]);
  }
  out.depth_metres = std::sqrt(scale[2]);
  out.texel = 2 * std::sqrt(std::min(scale[0], scale[1])) / size;
  const double sink = axes[2].z * scale[2];  // how the height grows with depth
  if (sink > -1e-3 * out.depth_metres) return out;
  const double right = axes[0].z * scale[0] / -sink, up = axes[1].z * scale[1] / -sink;
  out.ground = {float(0.5 + middle / -sink - right - up), float(2 * right), float(2 * up)};
  return out;
}

// Texels that a piece's bounding sphere may cover.
TexelRect rect_of(const Rows& rows, const PlacedMesh& piece, int size) {
  int low[2], high[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 axis(rows[i][0], rows[i][1], rows[i][2]);
    const double at = dot(axis, Vec3(piece.centre)) + rows[i][3], reach = norm(axis) * double(piece.radius);
    const auto texel = [&](double x) { return std::clamp((x * 0.5 + 0.5) * size, -8.0, size + 8.0); };
    low[i] = int(texel(at - reach)) - 1, high[i] = int(texel(at + reach)) + 2;
  }
  return {low[0], low[1], high[0], high[1]};
}

long long area(const TexelRect& r) { return (long long)(r.x1 - r.x0) * (r.y1 - r.y0); }

TexelRect both(const TexelRect& a, const TexelRect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

ShadowViews::ShadowViews(const PreparedScene& scene, const LightSet& set, int most_side) : side(most_side) {
  place(scene, set);
  const std::size_t most_texels = scene.surrounded ? kMostTexelsAround : kMostTexels;
  while (rows.size() * std::size_t(side) * std::size_t(side) > most_texels) {
    side /= 2;
    place(scene, set);
  }
}

void ShadowViews::place(const PreparedScene& scene, const LightSet& set) {
  rows.clear(), lights.clear(), clip_from_world.clear();
  for (const LightModel& light : set.lights) {
    Light entry;
    const std::vector<Rows> views = make_views(scene, light, side, entry);
    entry.directional = light.type == LightType::directional;
    entry.first_view = int(rows.size()), entry.views = int(views.size());
    lights.push_back(entry);
    rows.insert(rows.end(), views.begin(), views.end());
  }
  for (const Rows& view : rows) {
    std::array<std::array<float, 4>, 4> floats;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c) floats[r][c] = float(view[r][c]);
    clip_from_world.push_back(floats);
  }
}

std::vector<EdgeView> ShadowViews::sun_edges() const {
  std::vector<EdgeView> out;
  if (!has_sun()) return out;
  for (std::size_t i = 0; i < std::size_t(lights.front().views); ++i) out.push_back(edge_view(rows[i], side));
  return out;
}

std::vector<EdgeLayer> ShadowViews::edge_layers(const std::vector<EdgePyramid>& pyramids) const {
  std::vector<EdgeLayer> out;
  for (std::size_t i = 0; i < pyramids.size(); ++i) {
    const auto& view = clip_from_world[i];
    out.push_back({{view[0], view[1], view[2]}, &pyramids[i]});
  }
  return out;
}

std::vector<TexelRect> ShadowViews::moving_rects(const PreparedScene& scene, std::size_t view) const {
  std::vector<TexelRect> out;
  for (const PlacedMesh& piece : scene.placed)
    if (piece.moves && piece.there) out.push_back(rect_of(rows[view], piece, side));
  return out;
}

int EdgeView::reach() const {
  const double deepest = double(ground[0] + std::max(ground[1], 0.0f) + std::max(ground[2], 0.0f));
  const double tiles = double(kSunRadius) * depth_metres * std::max(1.0, deepest) / (kTile * texel);
  return int(std::min(std::ceil(tiles + double(kMargin) / kTile), double(kMostReach)));
}

std::vector<TexelRect> merge_rects(std::vector<TexelRect> rects) {
  for (std::size_t i = 0; i < rects.size();) {
    bool merged = false;
    for (std::size_t k = 0; k < i && !merged; ++k) {
      const TexelRect whole = both(rects[i], rects[k]);
      merged = area(whole) <= area(rects[i]) + area(rects[k]);
      if (!merged) continue;
      rects[k] = whole;
      rects.erase(rects.begin() + std::ptrdiff_t(i));
      i = k;  // the larger one may overlap others
    }
    if (!merged) ++i;
  }
  return rects;
}

bool casts_shadow(const PlacedMesh& piece, ShadowPart part) {
  if (piece.id == kGroundId || !piece.there) return false;  // nothing lies under the ground
  return part == ShadowPart::all || piece.moves == (part == ShadowPart::moving);
}

std::array<std::array<float, 4>, 4> clip_from_mesh(const ShadowViews::Rows& rows, const PlacedMesh& piece) {
  const Mat3 r = piece.world_from_mesh.rotation.matrix() * piece.scale;
  const Vec3 t = piece.world_from_mesh.translation;
  std::array<std::array<float, 4>, 4> out;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 v(rows[i][0], rows[i][1], rows[i][2]);
    for (std::size_t k = 0; k < 3; ++k) out[i][k] = float(dot(v, r.column(int(k))));
    out[i][3] = float(dot(v, t) + rows[i][3]);
  }
  return out;
}

bool is_opaque(const PreparedMesh& mesh, std::uint32_t triangle) {
  return !mesh.glass || mesh.triangles[triangle].material != glass_appearance();
}

}  // namespace rubble
