#include "render/passes/visibility_pass.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "kernel/base/error.h"
#include "render/shader.h"

namespace rubble {

namespace {

// Before any depth is known, draw the nearest pieces up to this many triangles.
constexpr std::size_t kFirstBatch = 150000;

}  // namespace

DrawList::DrawList(const Gl& gl, const GpuGeometry& geometry)
    : gl_(&gl), command_buffer_(gl), record_buffer_(gl), array_(gl) {
  const GLuint a = array_.name();
  gl.VertexArrayVertexBuffer(a, 0, geometry.vertices.name(), 0, 16);
  gl.VertexArrayVertexBuffer(a, 1, record_buffer_.name(), 0, sizeof(DrawRecord));
  gl.VertexArrayBindingDivisor(a, 1, 1);
  gl.VertexArrayElementBuffer(a, geometry.indices.name());
  const auto attribute = [&](GLuint index, GLuint binding, GLint parts, std::size_t offset) {
    gl.EnableVertexArrayAttrib(a, index);
    gl.VertexArrayAttribFormat(a, index, parts, GL_FLOAT, GL_FALSE, GLuint(offset));
    gl.VertexArrayAttribBinding(a, index, binding);
  };
  attribute(0, 0, 3, 0);
  attribute(1, 1, 4, offsetof(DrawRecord, clip_x));
  attribute(2, 1, 4, offsetof(DrawRecord, clip_y));
  attribute(3, 1, 4, offsetof(DrawRecord, clip_w));
  gl.EnableVertexArrayAttrib(a, 4);
  gl.VertexArrayAttribIFormat(a, 4, 1, GL_UNSIGNED_INT, offsetof(DrawRecord, placed));
  gl.VertexArrayAttribBinding(a, 4, 1);
  attribute(5, 1, 4, offsetof(DrawRecord, clip_z));
}

std::size_t DrawList::triangle_count() const {
  std::size_t sum = 0;
  for (const DrawCommand& c : commands_) sum += c.count / 3;
  return sum;
}

void DrawList::add_run(std::uint32_t first_index, std::uint32_t count) {
  commands_.push_back({count, 1, first_index, 0, std::uint32_t(records_.size() - 1)});
}

void DrawList::draw() {
  if (commands_.empty()) return;
  gl_->NamedBufferData(record_buffer_.name(), GLsizeiptr(records_.size() * sizeof(DrawRecord)),
                       records_.data(), GL_STREAM_DRAW);
  gl_->NamedBufferData(command_buffer_.name(), GLsizeiptr(commands_.size() * sizeof(DrawCommand)),
                       commands_.data(), GL_STREAM_DRAW);
  gl_->BindVertexArray(array_.name());
  gl_->BindBuffer(GL_DRAW_INDIRECT_BUFFER, command_buffer_.name());
  gl_->MultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, GLsizei(commands_.size()),
                                 0);
}

VisibilityPass::VisibilityPass(const Gl& gl, const PreparedScene& scene,
                               const GpuGeometry& geometry, const VisibilityOptions& options)
    : gl_(gl),
      scene_(scene),
      geometry_(geometry),
      options_(options),
      program_(make_program(gl, "visibility.vert.glsl", "visibility.frag.glsl",
                            {{"NEAR_PLANE", std::to_string(kNearPlane)}})),
      list_(gl, geometry),
      shown_(scene.cluster_flags, 0),
      drawn_(scene.cluster_flags, 0) {}

void VisibilityPass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  ids_ = make_target(gl_, GL_RG32UI, width, height);
  depth_ = make_target(gl_, GL_DEPTH_COMPONENT32F, width, height);
  target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, ids_.name(), 0);
  gl_.NamedFramebufferTexture(target_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  check_gl(gl_, "making the image buffers");
  if (gl_.CheckNamedFramebufferStatus(target_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw RunError("the graphics device cannot draw triangle numbers and depth together");
  values_.assign(std::size_t(width) * std::size_t(height), 0);
}

std::uint32_t VisibilityPass::choose_level(const PlacedMesh& piece, float z, double focal) const {
  const auto& levels = scene_.meshes[piece.mesh].levels;
  if (options_.coarse_below <= 0 || z < piece.radius) return 0;
  // The mean side of a triangle if they covered a sphere of the piece's size evenly.
  const double size = 2 * double(piece.radius) * focal / double(z);
  std::uint32_t level = 0;
  while (level + 1 < levels.size() &&
         1.8 * size / std::sqrt(double(levels[level].triangle_count)) < options_.coarse_below)
    ++level;
  return level;
}

void VisibilityPass::find_candidates(const ViewProjection& view) {
  const ViewVolume volume(view);
  candidates_.clear();
  const Mat3f turn{{Vec3f(view.optical_from_world.rotation.matrix().rows[0]),
                    Vec3f(view.optical_from_world.rotation.matrix().rows[1]),
                    Vec3f(view.optical_from_world.rotation.matrix().rows[2])}};
  const Vec3f shift(view.optical_from_world.translation);
  const double focal = std::max(view.intrinsics.fx, view.intrinsics.fy);
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    const Vec3f c = turn * piece.centre + shift;
    if (!volume.sphere_in_view(c, piece.radius)) continue;
    candidates_.push_back({i, choose_level(piece, c.z, focal), norm(c) - piece.radius * 0.5f});
  }
  // Near ones first, so that they hide the others' fragments; ties in order of placing.
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
}

void VisibilityPass::add_piece(const Candidate& candidate, const ViewProjection& view,
                               const ViewVolume& volume, bool second) {
  const PlacedMesh& piece = scene_.placed[candidate.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const PreparedLevel& level = mesh.levels[candidate.level];
  const Pose optical_from_mesh = view.optical_from_world * piece.world_from_mesh;
  const Mat3 r = optical_from_mesh.rotation.matrix();
  const Mat3f turn{{Vec3f(r.rows[0] * piece.scale), Vec3f(r.rows[1] * piece.scale),
                    Vec3f(r.rows[2] * piece.scale)}};
  const Vec3f shift(optical_from_mesh.translation);
  const float scale = float(piece.scale);
  const auto box_shows = [&](const Vec3f& centre, const Vec3f& half) {
    const Mat3f sides{{turn.column(0) * half.x, turn.column(1) * half.y, turn.column(2) * half.z}};
    return volume.box_may_show(centre, sides, pyramid_);
  };
  if (second && !box_shows(turn * mesh.centre + shift, mesh.half)) {
    std::fill_n(shown_.begin() + piece.first_flag, mesh.levels[0].cluster_count, std::uint8_t(0));
    return;
  }
  const Vec3f eye(optical_from_mesh.inverse().translation * (1 / piece.scale));
  const bool whole = candidate.level > 0;  // coarse levels are small: all or nothing
  const std::size_t clusters = whole ? 1 : level.cluster_count;
  const std::uint32_t base = geometry_.first_index[piece.mesh];
  std::uint32_t run_first = 0, run_count = 0;
  const auto flush = [&] {
    if (!run_count) return;
    DrawRecord record{};
    const auto rows = view.clip_rows(piece.world_from_mesh, piece.scale);
    std::copy(rows[0].begin(), rows[0].end(), record.clip_x);
    std::copy(rows[1].begin(), rows[1].end(), record.clip_y);
    std::copy(rows[2].begin(), rows[2].end(), record.clip_w);
    record.placed = candidate.placed;
    list_.add_record(record);
    list_.add_run(base + run_first * 3, run_count * 3);
    run_count = 0;
  };
  for (std::size_t k = 0; k < clusters; ++k) {
    const Cluster& c = mesh.clusters[level.first_cluster + k];
    const std::size_t flag = piece.first_flag + k;
    const std::uint32_t first = whole ? level.first_triangle : c.first_triangle;
    const std::uint32_t count = whole ? level.triangle_count : c.triangle_count;
    bool wanted = true;
    if (!whole) {
      const Vec3f centre = turn * c.centre + shift;
      wanted = !faces_away(eye, c.centre, c.radius, c.cone_axis, c.cone_cosine) &&
               volume.sphere_in_view(centre, c.radius * scale) &&
               (!second || box_shows(centre, c.half));
    }
    if (second) {
      shown_[flag] = wanted;
      wanted = wanted && !drawn_[flag];
    } else {
      wanted = wanted && (shown_[flag] || !have_history_);
    }
    drawn_[flag] |= std::uint8_t(wanted);
    if (wanted && run_count && run_first + run_count != first) flush();
    if (wanted && !run_count) run_first = first;
    if (wanted)
      run_count += count;
    else
      flush();
  }
  flush();
}

void VisibilityPass::read_depth() {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target_.name());
  gl_.ReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, values_.data());
}

std::vector<std::uint32_t> VisibilityPass::read_ids() const {
  std::vector<std::uint32_t> out(std::size_t(width_) * std::size_t(height_) * 2);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target_.name());
  gl_.ReadPixels(0, 0, width_, height_, GL_RG_INTEGER, GL_UNSIGNED_INT, out.data());
  check_gl(gl_, "reading the triangle numbers back");
  return out;
}

void VisibilityPass::draw(const ViewProjection& view) {
  resize(view.intrinsics.width, view.intrinsics.height);
  const float zero[4] = {0, 0, 0, 0};
  const GLuint none[4] = {0, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(target_.name(), GL_DEPTH, 0, zero);
  gl_.ClearNamedFramebufferuiv(target_.name(), GL_COLOR, 0, none);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_.Viewport(0, 0, width_, height_);
  gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_GREATER);
  gl_.DepthMask(GL_TRUE);
  gl_.Enable(GL_CULL_FACE);
  gl_.FrontFace(GL_CW);  // rows run downwards, which mirrors the triangles
  gl_.UseProgram(program_.name());

  const ViewVolume volume(view);
  find_candidates(view);
  std::fill(drawn_.begin(), drawn_.end(), std::uint8_t(0));
  const bool cull = options_.occlusion_culling;
  if (!cull) have_history_ = false;
  list_.clear();
  for (const Candidate& c : candidates_) {
    add_piece(c, view, volume, false);
    if (cull && !have_history_ && list_.triangle_count() > kFirstBatch) break;
  }
  counts_ = {list_.triangle_count(), list_.triangle_count()};
  list_.draw();
  read_depth();
  if (!cull) return;
  pyramid_.build(values_.data(), width_, height_);
  list_.clear();
  for (const Candidate& c : candidates_) add_piece(c, view, volume, true);
  counts_.triangles += list_.triangle_count();
  have_history_ = true;
  if (list_.empty()) return;
  list_.draw();
  read_depth();
}

}  // namespace rubble
