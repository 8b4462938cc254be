#include "render/view/surface_drawer.h"

#include <cmath>
#include <limits>
#include <utility>

namespace rubble {

namespace {

constexpr int kPixelsAJob = 1 << 14;
constexpr int kRowsAJob = 16;

std::vector<float> metric_depth(const std::vector<float>& values, ThreadPool& pool) {
  std::vector<float> out(values.size());
  const float none = std::numeric_limits<float>::quiet_NaN();
  pool.run(int(values.size()), kPixelsAJob, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
      out[i] = values[i] > 0 ? kNearPlane / values[i] : none;
  });
  return out;
}

// Along the rays of a pinhole, from planar depth.
std::vector<float> distances_of(const std::vector<float>& depth, const Intrinsics& k, ThreadPool& pool) {
  std::vector<float> out(depth.size());
  pool.run(k.height, kRowsAJob, [&](int begin, int end) {
    std::size_t i = std::size_t(begin) * std::size_t(k.width);
    for (int v = begin; v < end; ++v)
      for (int u = 0; u < k.width; ++u, ++i)
        out[i] = float(double(depth[i]) * norm(Vec3((double(u) - k.cx) / k.fx, (double(v) - k.cy) / k.fy, 1)));
  });
  return out;
}

// two: numbers a pixel, as TriangleRaster::ids(). Most pixels show what the one before or above shows.
void add_shown(const std::uint32_t* two, const Intrinsics& k, const std::vector<std::uint32_t>& triangle_of_name,
               ThreadPool& pool, std::vector<LampBounce::Shown>& out) {
  const std::size_t width = 2 * std::size_t(k.width);
  std::vector<std::vector<LampBounce::Shown>> parts(std::size_t((k.height + kRowsAJob - 1) / kRowsAJob));
  pool.run(k.height, kRowsAJob, [&](int begin, int end) {
    std::vector<LampBounce::Shown>& part = parts[std::size_t(begin / kRowsAJob)];
    for (std::size_t first = std::size_t(begin) * width; first < std::size_t(end) * width; first += width)
      for (std::size_t i = first; i < first + width; i += 2) {
        const auto same = [&](std::size_t other) { return two[i] == two[other] && two[i + 1] == two[other + 1]; };
        if (!two[i] || (i > first && same(i - 2)) || (first > std::size_t(begin) * width && same(i - width))) continue;
        part.push_back({two[i] - 1, triangle_of_name[two[i + 1]]});
      }
  });
  for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
}

}  // namespace

SurfaceDrawer::SurfaceDrawer(LitScene& scene)
    : scene_(scene),
      raster_(scene.on_device->raster()),
      visibility_(scene.scene, raster_,
                  VisibilityOptions{scene.options.occlusion_culling, scene.options.coarse_below}, scene.pool) {}

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
    triangles_.reset();
  } else {
    if (!drawer_.rays_)
      drawer_.rays_ =
          std::make_unique<RayPass>(lit.scene, lit.on_device->names(), lit.rays, lit.options.threads);
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
  if (in_raster()) left_ = drawer_.raster_.leave();
  if (left_) return;
  ids(), planar_depth(), distances(), triangles();
  saved_depth_values_ = depth_values();
}

std::size_t DrawnSurfaces::triangles() {
  if (!triangles_) triangles_ = left_ ? left_->triangles() : in_raster() ? drawer_.visibility_.counts().triangles : 0;
  return *triangles_;
}

// Glass. ids: of the view.
void DrawnSurfaces::find_behind(const std::uint32_t* ids) {
  LitScene& lit = drawer_.scene_;
  if (found_behind_ || !lit.scene.glass) return;
  found_behind_ = true;
  if (!drawer_.glass_)
    drawer_.glass_ = std::make_unique<GlassRays>(lit.scene, lit.on_device->names(), lit.rays, lit.options.threads);
  behind_ = drawer_.glass_->find(view_, ids ? ids : this->ids().data(), depth_values());
}

SurfaceImages DrawnSurfaces::images() {
  SurfaceImages out = front_images();
  find_behind(out.ids);
  out.behind = &behind_;
  return out;
}

const std::vector<float>& DrawnSurfaces::depth_behind() {
  return behind_.empty() ? depth_values() : behind_.back().depth_values;
}

const std::uint32_t* DrawnSurfaces::ids_in_place() {
  if (in_raster()) return drawer_.raster_.ids();
  return ids().data();
}

SurfaceImages DrawnSurfaces::front_images() {
  if (!view_.plain() && !in_pass()) draw();
  SurfaceImages out{ids_in_place(), on_device_alone() ? nullptr : &depth_values(), in_raster()};
  if (view_.plain()) return out;
  const RayPass& rays = *drawer_.rays_;
  out.ray_values = rays.ray_values().data(), out.pose_values = rays.pose_values().data(), out.lens = rays.lens();
  return out;
}

const std::vector<std::uint32_t>& DrawnSurfaces::ids() {
  if (ids_.empty())
    ids_ = left_ ? left_->ids() : view_.plain() ? drawer_.raster_.read_ids() : drawer_.rays_->ids();
  return ids_;
}

std::vector<LampBounce::Shown> DrawnSurfaces::shown() {
  const std::uint32_t* drawn = ids_in_place();
  const std::uint32_t* two = drawn ? drawn : ids().data();
  const std::vector<std::uint32_t>& triangles = drawer_.scene_.on_device->names().triangle_of_name;
  std::vector<LampBounce::Shown> out;
  add_shown(two, view_.intrinsics, triangles, drawer_.scene_.pool, out);
  for (const GlassLayer& layer : behind_)
    add_shown(layer.ids.data(), view_.intrinsics, triangles, drawer_.scene_.pool, out);
  return out;
}

std::optional<std::vector<std::uint32_t>> DrawnSurfaces::shown_pieces() {
  const std::uint32_t* drawn = ids_in_place();
  if (!drawn) return {};
  const std::size_t count =
      2 * std::size_t(view_.intrinsics.width) * std::size_t(view_.intrinsics.height);
  std::vector<std::uint8_t> shows(drawer_.scene_.scene.placed.size() + 1, 0);
  const auto mark = [&](const std::uint32_t* two) {
    for (std::size_t i = 0; i < count; i += 2) shows[two[i]] = 1;
  };
  mark(drawn);
  for (const GlassLayer& layer : behind_) mark(layer.ids.data());
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 1; i < shows.size(); ++i)
    if (shows[i]) out.push_back(i - 1);
  return out;
}

const std::vector<float>& DrawnSurfaces::depth_values() {
  if (left_) return left_->depth_values();
  if (!in_pass()) return saved_depth_values_;
  return view_.plain() ? drawer_.raster_.depth_values() : drawer_.rays_->depth_values();
}

const std::vector<float>& DrawnSurfaces::planar_depth() {
  if (planar_depth_.empty())
    planar_depth_ = view_.plain() ? metric_depth(depth_values(), drawer_.scene_.pool) : drawer_.rays_->planar_depth();
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
    distances_ = view_.plain() ? distances_of(planar_depth(), view_.intrinsics, drawer_.scene_.pool) : drawer_.rays_->distances();
  return distances_;
}

}  // namespace rubble
