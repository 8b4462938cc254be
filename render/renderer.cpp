#include "render/renderer.h"

#include <algorithm>
#include <deque>

#include "kernel/base/error.h"
#include "render/view/view_source.h"

namespace rubble {

namespace {

ViewRays pinhole_view(const Pose& world_from_camera, const Intrinsics& k, std::int64_t stamp_ns) {
  return {stamp_ns, k, world_from_camera};
}

// That of a frame of this number.
ViewRays numbered_view(const Pose& world_from_camera, const Intrinsics& k, int index, std::int64_t stamp_ns) {
  ViewRays rays = pinhole_view(world_from_camera, k, stamp_ns);
  rays.noise = 2 * std::uint64_t(index);  // as the left image of a Camera
  return rays;
}

constexpr std::size_t kMostAhead = 4;  // views of a device at once

}  // namespace

Renderer::Renderer(Device& device, const Scene& scene, const RenderOptions& options,
                   const Progress& progress) {
  device.make_current();
  // The rest of the preparation is the making of textures, which mostly lie in the cache.
  const auto report = [&](double fraction) {
    if (progress) progress(fraction);
  };
  source_ = std::make_unique<ViewSource>(device, scene, options,
                                         [&](double fraction) { report(0.9 * fraction); });
  report(1);
}

Renderer::~Renderer() {
  if (!source_) return;
  try {
    source_->scene.device.make_current();  // so that what it made there can be deleted
  } catch (const RunError&) {
    // Nothing can be deleted without a context; the driver frees it with the context.
  }
}

void Renderer::restart(const LampSpec& lamp, const AirSpec& air) {
  source_->scene.device.make_current();
  source_->scene.change(lamp, air);
  source_->colours.restart();
  source_->drops.restart();
}

RenderedView Renderer::view(const ViewRays& rays, const ViewRays* next) {
  return RenderedView(*source_, rays, next);
}

bool Renderer::runs_ahead() const {
  return source_->scene.device.runs_ahead() && !source_->scene.is_traced();
}

std::shared_ptr<LightWatch> Renderer::watch_light(const WatchedPixels& pixels) {
  Device& device = source_->scene.device;
  device.make_current();
  std::unique_ptr<LightWatch> watch = source_->colours.make_light_watch(pixels);
  if (!watch) return nullptr;
  return {watch.release(), [&device](LightWatch* one) {
            try {
              device.make_current();  // for what it has on the device
            } catch (const RunError&) {
              // The driver frees it with the context.
            }
            delete one;
          }};
}

void Renderer::add_drops(const ExposedView& exposed, std::vector<float>& radiance) {
  source_->drops.add(exposed, radiance);
}

const Medium& Renderer::medium() const { return source_->scene.medium; }

Frame Renderer::render(const Pose& world_from_camera, const Intrinsics& intrinsics, int index,
                       std::int64_t stamp_ns) {
  return render(numbered_view(world_from_camera, intrinsics, index, stamp_ns), index);
}

void Renderer::render(const std::vector<Pose>& world_from_camera, const Intrinsics& intrinsics, int index, std::int64_t stamp_ns,
                      const std::function<void(Frame)>& take) {
  const std::size_t ahead = runs_ahead() ? kMostAhead : 1;
  std::deque<RenderedView> begun;
  for (std::size_t i = 0, next = 0; i < world_from_camera.size(); ++i) {
    for (; next < std::min(i + ahead, world_from_camera.size()); ++next) {
      begun.push_back(view(numbered_view(world_from_camera[next], intrinsics, index + int(next), stamp_ns)));
      begun.back().begin();
    }
    take(std::move(begun.front()).into_frame(index + int(i)));
    begun.pop_front();
  }
}

Frame Renderer::render(const ViewRays& rays, int index) { return view(rays).into_frame(index); }

LinearFrame Renderer::render_linear(const Pose& world_from_camera, const Intrinsics& intrinsics) {
  return render_linear(pinhole_view(world_from_camera, intrinsics, 0));
}

LinearFrame Renderer::render_linear(const ViewRays& rays) {
  return view(rays).into_linear_frame();
}

}  // namespace rubble
