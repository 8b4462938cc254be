#include "render/devices/gl/gl_shadow_pass.h"

#include <algorithm>

#include "render/devices/gl/draw_list.h"
#include "render/gl/shader.h"

namespace rubble {

namespace {

int texture_side(const Gl& gl, int most_side) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  return std::min(most_side, int(most));
}

DrawRecord shadow_record(const ShadowViews::Rows& rows, const PlacedMesh& piece) {
  const auto clip = clip_from_mesh(rows, piece);
  DrawRecord record{};
  float* out[4] = {record.clip_x, record.clip_y, record.clip_z, record.clip_w};
  for (std::size_t i = 0; i < 4; ++i) std::copy(clip[i].begin(), clip[i].end(), out[i]);
  return record;
}

void add_opaque(const PreparedMesh& mesh, std::uint32_t first_index, DrawList& list) {
  const PreparedLevel& level = mesh.levels.front();
  const std::uint32_t last = level.first_triangle + level.triangle_count;
  for (std::uint32_t t = level.first_triangle, end; t < last; t = end) {
    end = mesh.glass ? t + 1 : last;
    while (end < last && is_opaque(mesh, end) == is_opaque(mesh, t)) ++end;
    if (is_opaque(mesh, t)) list.add_run(first_index + t * 3, (end - t) * 3);
  }
}

}  // namespace

GlShadowPass::GlShadowPass(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry, const LightSet& lights,
                           int most_side)
    : gl_(gl), scene_(scene), geometry_(geometry), lights_(lights), views_(scene, lights, texture_side(gl, most_side)) {
  for (const PlacedMesh& piece : scene.placed) moves_ = moves_ || piece.moves;
  program_ = make_program(gl, "visibility.vert.glsl", "visibility.frag.glsl", {{"SHADOW", ""}});
  depth_ = make_layers();
  targets_ = make_targets(depth_);
  draw_layers(ShadowPart::resting);
  values_ = make_values(depth_);
  std::vector<EdgeView> sun = views_.sun_edges();
  if (!sun.empty()) {
    edges_ = std::make_unique<ShadowEdgePass>(gl, views_.side, std::move(sun));
    edges_->find(values_);
  }
  if (!moves_) return;
  resting_ = std::move(depth_);
  depth_ = make_layers();
  targets_ = make_targets(depth_);
  values_ = make_values(depth_);
  if (edges_) edges_->keep();
}

GlTexture GlShadowPass::make_layers() const {
  GlTexture layers(gl_, GLenum(GL_TEXTURE_2D_ARRAY));
  const GLuint name = layers.name();
  gl_.TextureStorage3D(name, 1, GL_DEPTH_COMPONENT32F, views_.side, views_.side, GLsizei(views_.rows.size()));
  gl_.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  check_gl(gl_, "making the shadow map");
  return layers;
}

std::vector<GlFramebuffer> GlShadowPass::make_targets(const GlTexture& layers) const {
  std::vector<GlFramebuffer> out;
  for (std::size_t i = 0; i < views_.rows.size(); ++i) {
    out.emplace_back(gl_);
    gl_.NamedFramebufferTextureLayer(out.back().name(), GL_DEPTH_ATTACHMENT, layers.name(), 0, GLint(i));
    gl_.NamedFramebufferDrawBuffers(out.back().name(), 0, nullptr);
  }
  return out;
}

GlTexture GlShadowPass::make_values(const GlTexture& layers) const {
  GlTexture values(gl_);
  gl_.TextureView(values.name(), GL_TEXTURE_2D_ARRAY, layers.name(), GL_DEPTH_COMPONENT32F, 0, 1, 0,
                  GLuint(views_.rows.size()));
  gl_.TextureParameteri(values.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TextureParameteri(values.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_.TextureParameteri(values.name(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  check_gl(gl_, "making a view of the shadow map");
  return values;
}

void GlShadowPass::move() {
  if (!moves_) return;
  const int side = views_.side;
  gl_.CopyImageSubData(resting_.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, depth_.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0,
                       side, side, GLsizei(views_.rows.size()));
  draw_layers(ShadowPart::moving);
  if (edges_) {
    std::vector<std::vector<TexelRect>> changed;
    for (std::size_t i = 0; i < std::size_t(views_.lights.front().views); ++i)
      changed.push_back(views_.moving_rects(scene_, i));
    edges_->find_again(values_, changed);
  }
  if (lights_.carried == 0) return;
  views_.place(scene_, lights_);
  draw_layers(ShadowPart::all, std::size_t(views_.lights[lights_.first_carried()].first_view));
}

void GlShadowPass::draw_layers(ShadowPart part, std::size_t from) {
  gl_.UseProgram(program_.name());
  gl_.Viewport(0, 0, views_.side, views_.side);
  gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_DEPTH_CLAMP);
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_CULL_FACE);
  for (std::size_t i = from; i < views_.rows.size(); ++i) {
    const GlFramebuffer& target = targets_[i];
    const float far_value = 1;
    if (part != ShadowPart::moving) gl_.ClearNamedFramebufferfv(target.name(), GL_DEPTH, 0, &far_value);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
    draw_view(views_.rows[i], part);
  }
  gl_.Disable(GL_DEPTH_CLAMP);
  check_gl(gl_, "drawing the shadow map");
}

void GlShadowPass::draw_view(const ShadowViews::Rows& rows, ShadowPart part) {
  DrawList list(gl_, geometry_);
  for (const PlacedMesh& piece : scene_.placed) {
    if (!casts_shadow(piece, part)) continue;
    list.add_record(shadow_record(rows, piece));
    add_opaque(scene_.meshes[piece.mesh], geometry_.first_index(piece.mesh, 0), list);
  }
  list.draw();
}

}  // namespace rubble
