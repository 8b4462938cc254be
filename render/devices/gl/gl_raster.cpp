#include "render/devices/gl/gl_raster.h"

#include <algorithm>
#include <string>
#include <utility>

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

constexpr std::size_t kMostImages = 6;  // from here on those that nobody has are given up before others are made

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
      readback_(gl) {
  bind_samplers(gl, plane_program_,
                {{"visibility", 0}, {"vertex_table", 1}, {"triangle_table", 2}, {"placed_table", 3}});
  gl.UniformBlockBinding(plane_program_.name(), gl.GetUniformBlockIndex(plane_program_.name(), "Plane"), 0);
}

void GlRaster::begin(const ViewProjection& view) {
  view_ = &view;
  choose_images(view.intrinsics.width, view.intrinsics.height);
  const float zero[4] = {0, 0, 0, 0};
  const GLuint none[4] = {0, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(drawn_->target.name(), GL_DEPTH, 0, zero);
  gl_.ClearNamedFramebufferuiv(drawn_->target.name(), GL_COLOR, 0, none);
}

void GlRaster::prepare_to_draw() {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, drawn_->target.name());
  gl_.Viewport(0, 0, drawn_->width, drawn_->height);
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
  cull_->begin(candidates, list_, drawn_->width, drawn_->height);
  cull_->draw_first(list_, prepare);
  cull_->draw_others(list_, drawn_->depth, prepare);
  drawn_->triangles_coming = readback_.ask({cull_->triangles()});
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
  const GLuint textures[] = {drawn_->ids.name(), geometry_.vertices_view.name(),
                             geometry_.triangles_view.name(), geometry_.placed_view.name()};
  for (GLuint unit = 0; unit < 4; ++unit) gl_.BindTextureUnit(unit, textures[unit]);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, drawn_->plane_target.name());
  gl_.Viewport(0, 0, drawn_->width, drawn_->height);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.UseProgram(plane_program_.name());
  gl_.BindVertexArray(empty_array_.name());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  drawn_->values_coming = readback_.ask(drawn_->width, drawn_->height, GL_RED, GL_FLOAT);
  if (ids_wanted_) ask_ids(*drawn_);
  ids_wanted_ = false;
  check_gl(gl_, "drawing the triangles");
}

const std::vector<float>& GlRaster::take_values(Images& images) const {
  if (!images.values_taken) {
    images.values.resize(std::size_t(images.width) * std::size_t(images.height));
    images.values_coming->take(images.values.data());
  }
  images.values_taken = true;
  return images.values;
}

void GlRaster::ask_ids(Images& images) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, images.target.name());
  images.ids_coming = readback_.ask(images.width, images.height, GL_RG_INTEGER, GL_UNSIGNED_INT);
}

std::vector<std::uint32_t> GlRaster::take_ids(Images& images) const {
  ids_wanted_ = true;
  std::vector<std::uint32_t> out(std::size_t(images.width) * std::size_t(images.height) * 2);
  if (!images.ids_coming) ask_ids(images);
  images.ids_coming->take(out.data());
  check_gl(gl_, "reading the triangle numbers back");
  return out;
}

const std::vector<float>& GlRaster::depth_values() const { return take_values(*drawn_); }

std::vector<std::uint32_t> GlRaster::read_ids() const { return take_ids(*drawn_); }

std::size_t GlRaster::read_triangles() const {
  std::uint32_t out = 0;
  drawn_->triangles_coming->take(&out);
  return out;
}

class GlRaster::Left : public LeftImages {
 public:
  Left(const GlRaster& raster, std::shared_ptr<Images> images) : raster_(raster), images_(std::move(images)) {}

  const std::vector<float>& depth_values() override { return raster_.take_values(*images_); }
  std::vector<std::uint32_t> ids() override { return raster_.take_ids(*images_); }
  std::size_t triangles() override {
    std::uint32_t out = 0;
    if (images_->triangles_coming) images_->triangles_coming->take(&out);
    return out;
  }

 private:
  const GlRaster& raster_;
  std::shared_ptr<Images> images_;
};

std::unique_ptr<LeftImages> GlRaster::leave() { return std::make_unique<Left>(*this, drawn_); }

std::shared_ptr<GlRaster::Images> GlRaster::make_images(int width, int height) const {
  auto out = std::make_shared<Images>();
  out->width = width, out->height = height;
  out->ids = make_target(gl_, GL_RG32UI, width, height);
  out->depth = make_target(gl_, GL_DEPTH_COMPONENT32F, width, height);
  out->plane_depth = make_target(gl_, GL_R32F, width, height);
  out->target = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(out->target.name(), GL_COLOR_ATTACHMENT0, out->ids.name(), 0);
  gl_.NamedFramebufferTexture(out->target.name(), GL_DEPTH_ATTACHMENT, out->depth.name(), 0);
  out->plane_target = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(out->plane_target.name(), GL_COLOR_ATTACHMENT0, out->plane_depth.name(), 0);
  check_gl(gl_, "making the image buffers");
  if (gl_.CheckNamedFramebufferStatus(out->target.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw RunError("the graphics device cannot draw triangle numbers and depth together");
  return out;
}

// Those of the view before are left alone while somebody has them. Cameras of a mission may have several sizes.
void GlRaster::choose_images(int width, int height) {
  drawn_.reset();
  const auto is_free = [](const std::shared_ptr<Images>& images) { return images.use_count() == 1; };
  for (const auto& images : images_) {
    if (is_free(images) && images->width == width && images->height == height) drawn_ = images;
  }
  if (!drawn_ && images_.size() >= kMostImages) images_.erase(std::remove_if(images_.begin(), images_.end(), is_free), images_.end());
  if (!drawn_) drawn_ = images_.emplace_back(make_images(width, height));
  drawn_->values_coming.reset(), drawn_->ids_coming.reset(), drawn_->triangles_coming.reset();
  drawn_->values_taken = false;
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
