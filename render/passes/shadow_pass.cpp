#include "render/passes/shadow_pass.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "render/gl/shader.h"
#include "render/materials/glass.h"
#include "render/passes/draw_list.h"

namespace rubble {

namespace {

using Rows = std::array<std::array<double, 4>, 4>;

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

std::vector<Rows> make_beam_views(const PreparedScene& scene, const LightModel& light, int size, ShadowMap::Light& out) {
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

std::vector<Rows> make_views(const PreparedScene& scene, const LightModel& light, int size, ShadowMap::Light& out) {
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
ShadowEdgePass::View edge_view(const Rows& rows, int size) {
  ShadowEdgePass::View out;
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
ShadowEdgePass::Rect rect_of(const Rows& rows, const PlacedMesh& piece, int size) {
  int low[2], high[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 axis(rows[i][0], rows[i][1], rows[i][2]);
    const double at = dot(axis, Vec3(piece.centre)) + rows[i][3], reach = norm(axis) * double(piece.radius);
    const auto texel = [&](double x) { return std::clamp((x * 0.5 + 0.5) * size, -8.0, size + 8.0); };
    low[i] = int(texel(at - reach)) - 1, high[i] = int(texel(at + reach)) + 2;
  }
  return {low[0], low[1], high[0], high[1]};
}

// rows * world_from_mesh * scale, as a draw record.
DrawRecord make_record(const Rows& rows, const PlacedMesh& piece) {
  const Mat3 r = piece.world_from_mesh.rotation.matrix() * piece.scale;
  const Vec3 t = piece.world_from_mesh.translation;
  DrawRecord record{};
  float* out[4] = {record.clip_x, record.clip_y, record.clip_z, record.clip_w};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 v(rows[i][0], rows[i][1], rows[i][2]);
    for (int k = 0; k < 3; ++k) out[i][k] = float(dot(v, r.column(k)));
    out[i][3] = float(dot(v, t) + rows[i][3]);
  }
  return record;
}

// The finest level but its glass, which lets light pass.
void add_solid(const PreparedMesh& mesh, std::uint32_t first_index, DrawList& list) {
  const PreparedLevel& level = mesh.levels.front();
  const std::uint32_t last = level.first_triangle + level.triangle_count;
  const auto is_glass = [&](std::uint32_t t) { return mesh.glass && mesh.triangles[t].material == glass_appearance(); };
  for (std::uint32_t t = level.first_triangle, end; t < last; t = end) {
    end = mesh.glass ? t + 1 : last;
    while (end < last && is_glass(end) == is_glass(t)) ++end;
    if (!is_glass(t)) list.add_run(first_index + t * 3, (end - t) * 3);
  }
}

}  // namespace

ShadowPass::ShadowPass(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry,
                       const LightSet& lights, int size, bool read_back)
    : gl_(gl), scene_(scene), geometry_(geometry), lights_(lights), moves_(false), read_back_(read_back) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  size_ = std::min(size, int(most));
  list_views();
  const std::size_t most_texels = scene.surrounded ? kMostTexelsAround : kMostTexels;
  while (views_.size() * std::size_t(size_) * std::size_t(size_) > most_texels) {
    size_ /= 2;
    list_views();
  }
  for (const PlacedMesh& piece : scene.placed) moves_ = moves_ || piece.moves;
  program_ = make_program(gl, "visibility.vert.glsl", "visibility.frag.glsl", {{"SHADOW", ""}});
  map_.depth = make_layers();
  draw_layers(map_.depth, What::resting);
  map_.values = make_values(map_.depth);
  if (has_sun()) {
    edges_ = std::make_unique<ShadowEdgePass>(gl, size_, edge_views());
    edges_->find(map_.values);
    map_.edges = edges_.get();
  }
  map_.side = size_;
  read_texels();
  if (!moves_) return;
  resting_ = std::move(map_.depth);
  map_.depth = make_layers();
  map_.values = make_values(map_.depth);
  if (edges_) edges_->keep();
}

void ShadowPass::list_views() {
  views_.clear();
  map_.lights.clear();
  map_.clip_from_world.clear();
  for (const LightModel& light : lights_.lights) {
    ShadowMap::Light entry;
    const std::vector<Rows> views = make_views(scene_, light, size_, entry);
    entry.first_view = int(views_.size()), entry.views = int(views.size());
    map_.lights.push_back(entry);
    views_.insert(views_.end(), views.begin(), views.end());
  }
  for (const Rows& view : views_) {
    std::array<std::array<float, 4>, 4> rows;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c) rows[r][c] = float(view[r][c]);
    map_.clip_from_world.push_back(rows);
  }
}

GlTexture ShadowPass::make_layers() const {
  GlTexture layers(gl_, GLenum(GL_TEXTURE_2D_ARRAY));
  const GLuint name = layers.name();
  gl_.TextureStorage3D(name, 1, GL_DEPTH_COMPONENT32F, size_, size_, GLsizei(views_.size()));
  gl_.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  check_gl(gl_, "making the shadow map");
  return layers;
}

std::vector<EdgeLayer> ShadowMap::edge_layers() const {
  std::vector<EdgeLayer> out;
  for (std::size_t i = 0; i < edges->pyramids().size(); ++i) {
    const auto& rows = clip_from_world[i];
    out.push_back({{rows[0], rows[1], rows[2]}, &edges->pyramids()[i]});
  }
  return out;
}

GlTexture ShadowPass::make_values(const GlTexture& layers) const {
  GlTexture values(gl_);
  gl_.TextureView(values.name(), GL_TEXTURE_2D_ARRAY, layers.name(), GL_DEPTH_COMPONENT32F, 0, 1, 0,
                  GLuint(views_.size()));
  gl_.TextureParameteri(values.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TextureParameteri(values.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_.TextureParameteri(values.name(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  check_gl(gl_, "making a view of the shadow map");
  return values;
}

bool ShadowPass::has_sun() const { return lights_.lights.front().type == LightType::directional; }

std::vector<ShadowEdgePass::View> ShadowPass::edge_views() const {
  std::vector<ShadowEdgePass::View> out;
  for (std::size_t i = 0; i < std::size_t(map_.lights.front().views); ++i) out.push_back(edge_view(views_[i], size_));
  return out;
}

// Where moving pieces are on a directional layer.
std::vector<ShadowPass::Rect> ShadowPass::moving_rects(std::size_t view) const {
  std::vector<Rect> out;
  for (const PlacedMesh& piece : scene_.placed)
    if (piece.moves && piece.there) out.push_back(rect_of(views_[view], piece, size_));
  return out;
}

void ShadowPass::find_moving_edges() {
  std::vector<std::vector<Rect>> changed;
  for (std::size_t i = 0; i < std::size_t(map_.lights.front().views); ++i) changed.push_back(moving_rects(i));
  edges_->find_again(map_.values, changed);
}

void ShadowPass::draw_moving() {
  if (!moves_) return;
  gl_.CopyImageSubData(resting_.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, map_.depth.name(),
                       GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, size_, size_, GLsizei(views_.size()));
  draw_layers(map_.depth, What::moving);
  if (edges_) find_moving_edges();
  if (lights_.carried > 0) {
    list_views();
    draw_layers(map_.depth, What::all, std::size_t(map_.lights[lights_.first_carried()].first_view));
  }
  read_moved_texels();
}

// All of it.
void ShadowPass::read_texels() {
  if (!read_back_) return;
  map_.texels.resize(views_.size() * std::size_t(size_) * std::size_t(size_));
  gl_.GetTextureImage(map_.depth.name(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                      GLsizei(map_.texels.size() * sizeof(float)), map_.texels.data());
  check_gl(gl_, "reading the shadow map");
}

// What may have changed since it was read: of directional layers where something moves or moved, of others all.
void ShadowPass::read_moved_texels() {
  if (!read_back_) return;
  moved_.resize(views_.size());
  for (std::size_t i = 0; i < lights_.lights.size(); ++i) {
    const ShadowMap::Light& light = map_.lights[i];
    for (std::size_t v = std::size_t(light.first_view); v < std::size_t(light.first_view + light.views); ++v) {
      if (lights_.lights[i].type != LightType::directional) {
        read_part(v, {0, 0, size_, size_});
        continue;
      }
      std::vector<Rect> rects = std::move(moved_[v]);
      moved_[v] = moving_rects(v);
      rects.insert(rects.end(), moved_[v].begin(), moved_[v].end());
      for (const Rect& rect : merge_rects(std::move(rects))) read_part(v, rect);
    }
  }
  check_gl(gl_, "reading the shadow map");
}

void ShadowPass::read_part(std::size_t view, const Rect& rect) {
  const int x0 = std::max(rect.x0, 0), y0 = std::max(rect.y0, 0), x1 = std::min(rect.x1, size_), y1 = std::min(rect.y1, size_);
  if (x0 >= x1 || y0 >= y1) return;
  const std::size_t side = std::size_t(size_), first = (view * side + std::size_t(y0)) * side + std::size_t(x0);
  gl_.PixelStorei(GL_PACK_ROW_LENGTH, size_);
  gl_.GetTextureSubImage(map_.depth.name(), 0, x0, y0, GLint(view), x1 - x0, y1 - y0, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                         GLsizei((map_.texels.size() - first) * sizeof(float)), map_.texels.data() + first);
  gl_.PixelStorei(GL_PACK_ROW_LENGTH, 0);
}

void ShadowPass::draw_layers(const GlTexture& layers, What what, std::size_t from) {
  gl_.UseProgram(program_.name());
  gl_.Viewport(0, 0, size_, size_);
  gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_DEPTH_CLAMP);
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_CULL_FACE);
  for (std::size_t i = from; i < views_.size(); ++i) {
    GlFramebuffer target(gl_);
    gl_.NamedFramebufferTextureLayer(target.name(), GL_DEPTH_ATTACHMENT, layers.name(), 0, GLint(i));
    gl_.NamedFramebufferDrawBuffers(target.name(), 0, nullptr);
    const float far_value = 1;
    if (what != What::moving) gl_.ClearNamedFramebufferfv(target.name(), GL_DEPTH, 0, &far_value);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
    draw_view(views_[i], what);
    gl_.Finish();
  }
  gl_.Disable(GL_DEPTH_CLAMP);
  check_gl(gl_, "drawing the shadow map");
}

void ShadowPass::draw_view(const Rows& rows, What what) {
  DrawList list(gl_, geometry_);
  for (const PlacedMesh& piece : scene_.placed) {
    if (piece.id == kGroundId) continue;  // nothing lies under it
    if (!piece.there || (what != What::all && piece.moves != (what == What::moving))) continue;
    list.add_record(make_record(rows, piece));
    add_solid(scene_.meshes[piece.mesh], geometry_.first_index[piece.mesh], list);
  }
  list.draw();
}

}  // namespace rubble
