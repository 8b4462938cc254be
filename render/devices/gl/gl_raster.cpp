#include "render/devices/gl/gl_raster.h"

#include <algorithm>
#include <string>

#include "kernel/base/error.h"
#include "render/devices/gl/draw_list.h"
#include "render/gl/gl_traffic.h"

namespace rubble {

namespace {

// Mirrors the block in shaders/plane_depth.frag.glsl.
struct PlaneBlock {
  float world_from_optical[3][4];
  float lens[4];
};

}  // namespace

GlRaster::GlRaster(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry)
    : gl_(gl),
      scene_(scene),
      geometry_(geometry),
      program_(make_program(gl, "visibility.vert.glsl", "visibility.frag.glsl",
                            {{"NEAR_PLANE", std::to_string(kNearPlane)}})),
      plane_program_(make_program(gl, "fullscreen.vert.glsl", "plane_depth.frag.glsl",
                                  {{"NEAR_PLANE", std::to_string(kNearPlane)}})),
      list_(gl, geometry),
      block_(gl),
      empty_array_(gl),
      values_back_(gl),
      ids_back_(gl) {
  bind_samplers(gl, plane_program_,
                {{"visibility", 0}, {"vertex_table", 1}, {"triangle_table", 2}, {"placed_table", 3}});
  gl.UniformBlockBinding(plane_program_.name(), gl.GetUniformBlockIndex(plane_program_.name(), "Plane"), 0);
}

void GlRaster::begin(const ViewProjection& view) {
  view_ = &view;
  resize(view.intrinsics.width, view.intrinsics.height);
  const float zero[4] = {0, 0, 0, 0};
  const GLuint none[4] = {0, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(target_.name(), GL_DEPTH, 0, zero);
  gl_.ClearNamedFramebufferuiv(target_.name(), GL_COLOR, 0, none);
}

void GlRaster::prepare_to_draw() {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_.Viewport(0, 0, width_, height_);
  gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_GREATER);
  gl_.DepthMask(GL_TRUE);
  gl_.Enable(GL_CULL_FACE);
  gl_.FrontFace(GL_CW);  // rows run downwards, which mirrors the triangles
  gl_.UseProgram(program_.name());
}

bool GlRaster::draw_what_shows(const std::vector<DrawCandidate>& candidates) {
  if (!cull_) cull_ = std::make_unique<CullPass>(gl_, scene_, geometry_);
  list_.clear();
  for (const DrawCandidate& candidate : candidates) add_record(candidate.placed);
  const auto prepare = [&] { prepare_to_draw(); };
  cull_->begin(candidates, list_, width_, height_);
  cull_->draw_first(list_, prepare);
  cull_->draw_others(list_, depth_, prepare);
  check_gl(gl_, "drawing what shows");
  return true;
}

void GlRaster::draw(const std::vector<ClusterRun>& runs) {
  prepare_to_draw();
  list_.clear();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i == 0 || runs[i].placed != runs[i - 1].placed) add_record(runs[i].placed);
    add_run(runs[i]);
  }
  list_.draw();
}

void GlRaster::finish() {
  PlaneBlock block{};
  const Mat3 r = view_->world_from_optical.rotation.matrix();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) block.world_from_optical[i][k] = float(r.rows[std::size_t(i)][k]);
    block.world_from_optical[i][3] = float(view_->world_from_optical.translation[i]);
  }
  const Intrinsics& k = view_->intrinsics;
  block.lens[0] = float(1 / k.fx), block.lens[1] = float(1 / k.fy);
  block.lens[2] = float(k.cx), block.lens[3] = float(k.cy);
  give_buffer(gl_, block_.name(), sizeof block, &block, GL_STREAM_DRAW);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, block_.name());
  const GLuint textures[] = {ids_.name(), geometry_.vertices_view.name(),
                             geometry_.triangles_view.name(), geometry_.placed_view.name()};
  for (GLuint unit = 0; unit < 4; ++unit) gl_.BindTextureUnit(unit, textures[unit]);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, plane_target_.name());
  gl_.Viewport(0, 0, width_, height_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.UseProgram(plane_program_.name());
  gl_.BindVertexArray(empty_array_.name());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  values_back_.ask(width_, height_, GL_RED, GL_FLOAT);
  ids_asked_ = ids_wanted_, ids_wanted_ = false;
  if (ids_asked_) ask_ids();
  values_asked_ = true;
  check_gl(gl_, "drawing the triangles");
}

const std::vector<float>& GlRaster::depth_values() const {
  if (values_asked_) values_back_.take(values_.data());
  values_asked_ = false;
  return values_;
}

void GlRaster::ask_ids() const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target_.name());
  ids_back_.ask(width_, height_, GL_RG_INTEGER, GL_UNSIGNED_INT);
}

std::vector<std::uint32_t> GlRaster::read_ids() const {
  ids_wanted_ = true;
  std::vector<std::uint32_t> out(values_.size() * 2);
  if (!ids_asked_) ask_ids();
  ids_back_.take(out.data());
  check_gl(gl_, "reading the triangle numbers back");
  return out;
}

void GlRaster::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  ids_ = make_target(gl_, GL_RG32UI, width, height);
  depth_ = make_target(gl_, GL_DEPTH_COMPONENT32F, width, height);
  plane_depth_ = make_target(gl_, GL_R32F, width, height);
  target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, ids_.name(), 0);
  gl_.NamedFramebufferTexture(target_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  plane_target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(plane_target_.name(), GL_COLOR_ATTACHMENT0, plane_depth_.name(), 0);
  check_gl(gl_, "making the image buffers");
  if (gl_.CheckNamedFramebufferStatus(target_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw RunError("the graphics device cannot draw triangle numbers and depth together");
  values_.assign(std::size_t(width) * std::size_t(height), 0);
}

void GlRaster::add_record(std::uint32_t placed) {
  const PlacedMesh& piece = scene_.placed[placed];
  const auto rows = view_->clip_rows(piece.world_from_mesh, piece.scale);
  DrawRecord record{};
  std::copy(rows[0].begin(), rows[0].end(), record.clip_x);
  std::copy(rows[1].begin(), rows[1].end(), record.clip_y);
  std::copy(rows[2].begin(), rows[2].end(), record.clip_w);
  record.placed = placed;
  const Vec3f eye((view_->optical_from_world * piece.world_from_mesh).inverse().translation * (1 / piece.scale));
  record.clip_z[0] = eye.x, record.clip_z[1] = eye.y, record.clip_z[2] = eye.z;
  list_.add_record(record);
}

void GlRaster::add_run(const ClusterRun& run) {
  const std::uint32_t m = scene_.placed[run.placed].mesh;
  const auto& clusters = scene_.meshes[m].clusters;
  const Cluster& last = clusters[run.first_cluster + run.cluster_count - 1];
  const std::uint32_t first = clusters[run.first_cluster].first_triangle;
  list_.add_run(geometry_.first_index(m, first),
                (last.first_triangle + last.triangle_count - first) * 3);
}

}  // namespace rubble
