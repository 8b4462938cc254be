#include "render/view/surface_drawer.h"

#include <cmath>
#include <limits>
#include <utility>

namespace rubble {

namespace {

std::vector<float> metric_depth(const std::vector<float>& values) {
  std::vector<float> out(values.size());
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < values.size(); ++i)
    out[i] = values[i] > 0 ? kNearPlane / values[i] : none;
  return out;
}

// Along the rays of a pinhole, from planar depth.
std::vector<float> distances_of(const std::vector<float>& depth, const Intrinsics& k) {
  std::vector<float> out(depth.size());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double u = double(i % std::size_t(k.width)), v = double(i / std::size_t(k.width));
    out[i] = float(double(depth[i]) * norm(Vec3((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1)));
  }
  return out;
}

// two: numbers a pixel, as VisibilityPass::ids(); count: of all numbers.
void add_shown(const std::uint32_t* two, std::size_t count, const std::vector<std::uint32_t>& triangle_of_name,
               std::vector<LampBounce::Shown>& out) {
  for (std::size_t i = 0; i < count; i += 2) {
    const bool again = i > 0 && two[i] == two[i - 2] && two[i + 1] == two[i - 1];
    if (two[i] && !again) out.push_back({two[i] - 1, triangle_of_name[two[i + 1]]});
  }
}

}  // namespace

SurfaceDrawer::SurfaceDrawer(LitScene& scene)
    : scene_(scene),
      visibility_(scene.gl, scene.scene, scene.geometry,
                  VisibilityOptions{scene.options.occlusion_culling, scene.options.coarse_below,
                                    scene.rasters_on_processor(), !scene.shades_on_processor(),
                                    scene.options.threads}) {}

DrawnSurfaces::DrawnSurfaces(SurfaceDrawer& drawer, const ViewRays& view)
    : drawer_(drawer), view_(view) {
  draw();
}

DrawnSurfaces::~DrawnSurfaces() {
  if (drawer_.in_visibility_ == this) drawer_.in_visibility_ = nullptr;
  if (drawer_.in_rays_ == this) drawer_.in_rays_ = nullptr;
}

void DrawnSurfaces::draw() {
  DrawnSurfaces*& drawn = view_.plain() ? drawer_.in_visibility_ : drawer_.in_rays_;
  if (drawn) drawn->save();
  drawn = nullptr;
  LitScene& lit = drawer_.scene_;
  lit.move_to(view_.stamp_ns);
  if (view_.plain()) {
    drawer_.visibility_.draw({view_.world_from_camera, view_.intrinsics});
    triangles_ = drawer_.visibility_.counts().triangles;
  } else {
    if (!drawer_.rays_)
      drawer_.rays_ = std::make_unique<RayPass>(lit.gl, lit.scene, lit.geometry, lit.rays,
                                                lit.options.threads, !lit.shades_on_processor());
    drawer_.rays_->draw(view_);
  }
  drawn = this;
}

bool DrawnSurfaces::in_pass() const {
  return drawer_.in_visibility_ == this || drawer_.in_rays_ == this;
}

// Another drawing might name another triangle where two lie at the very same depth, so the images
// are kept. Rays have no history: casting them again gives the same.
void DrawnSurfaces::save() {
  ids(), planar_depth(), distances();
  saved_depth_values_ = depth_values();
}

void DrawnSurfaces::upload() {
  const Gl& gl = drawer_.scene_.gl;
  const int width = view_.intrinsics.width, height = view_.intrinsics.height;
  saved_ids_ = make_target(gl, GL_RG32UI, width, height);
  saved_depth_ = make_target(gl, GL_R32F, width, height);
  gl.TextureSubImage2D(saved_ids_.name(), 0, 0, 0, width, height, GL_RG_INTEGER, GL_UNSIGNED_INT,
                       ids_.data());
  gl.TextureSubImage2D(saved_depth_.name(), 0, 0, 0, width, height, GL_RED, GL_FLOAT,
                       saved_depth_values_.data());
  check_gl(gl, "bringing back the surfaces of a view");
}

// Glass. ids: of the view.
void DrawnSurfaces::find_behind(const std::uint32_t* ids) {
  LitScene& lit = drawer_.scene_;
  if (found_behind_ || !lit.scene.glass) return;
  found_behind_ = true;
  if (!drawer_.glass_)
    drawer_.glass_ = std::make_unique<GlassRays>(lit.scene, lit.geometry, lit.rays, lit.options.threads);
  behind_ = drawer_.glass_->find(view_, ids ? ids : this->ids().data(), depth_values());
}

SurfaceImages DrawnSurfaces::images() {
  SurfaceImages out = front_images();
  find_behind(out.id_values);
  out.behind = &behind_;
  return out;
}

const std::vector<float>& DrawnSurfaces::depth_behind() {
  return behind_.empty() ? depth_values() : behind_.back().depth_values;
}

SurfaceImages DrawnSurfaces::front_images() {
  if (!view_.plain() && !in_pass()) draw();
  if (drawer_.scene_.shades_on_processor()) return images_in_memory();
  if (!view_.plain()) {
    const RayPass& rays = *drawer_.rays_;
    return {&rays.ids(), &rays.depth(),     rays.depth_values(),
            nullptr,     &rays.lens_rays(), &rays.row_poses()};
  }
  if (in_pass())
    return {&drawer_.visibility_.ids(), &drawer_.visibility_.depth(),
            drawer_.visibility_.depth_values(), nullptr};
  if (!saved_ids_) upload();
  return {&saved_ids_, &saved_depth_, saved_depth_values_, nullptr};
}

SurfaceImages DrawnSurfaces::images_in_memory() {
  SurfaceImages out{nullptr, nullptr, depth_values(), nullptr};
  if (!view_.plain()) {
    const RayPass& rays = *drawer_.rays_;
    out.ray_values = rays.ray_values().data(), out.pose_values = rays.pose_values().data();
  }
  const std::uint32_t* in_raster =
      view_.plain() && in_pass() ? drawer_.visibility_.id_values() : nullptr;
  out.id_values = in_raster ? in_raster : ids().data();
  return out;
}

const std::vector<std::uint32_t>& DrawnSurfaces::ids() {
  if (ids_.empty())
    ids_ = view_.plain() ? drawer_.visibility_.read_ids() : drawer_.rays_->id_values();
  return ids_;
}

std::vector<LampBounce::Shown> DrawnSurfaces::shown() {
  const std::uint32_t* drawn =
      view_.plain() && in_pass() ? drawer_.visibility_.id_values() : nullptr;
  const std::uint32_t* two = drawn ? drawn : ids().data();
  const std::size_t count =
      2 * std::size_t(view_.intrinsics.width) * std::size_t(view_.intrinsics.height);
  std::vector<LampBounce::Shown> out;
  add_shown(two, count, drawer_.scene_.geometry.triangle_of_name, out);
  for (const GlassLayer& layer : behind_)
    add_shown(layer.ids.data(), count, drawer_.scene_.geometry.triangle_of_name, out);
  return out;
}

const std::vector<float>& DrawnSurfaces::depth_values() {
  if (!in_pass()) return saved_depth_values_;
  return view_.plain() ? drawer_.visibility_.depth_values() : drawer_.rays_->depth_values();
}

const std::vector<float>& DrawnSurfaces::planar_depth() {
  if (planar_depth_.empty())
    planar_depth_ = view_.plain() ? metric_depth(depth_values()) : drawer_.rays_->planar_depth();
  return planar_depth_;
}

std::vector<float> DrawnSurfaces::take_planar_depth() {
  planar_depth();
  return std::move(planar_depth_);
}

std::vector<float> DrawnSurfaces::take_distances() {
  distances();
  return std::move(distances_);
}

const std::vector<float>& DrawnSurfaces::distances() {
  if (distances_.empty())
    distances_ =
        view_.plain() ? distances_of(planar_depth(), view_.intrinsics) : drawer_.rays_->distances();
  return distances_;
}

}  // namespace rubble
