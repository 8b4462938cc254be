#include "render/view/colour_drawer.h"

#include <algorithm>
#include <cmath>

#include "render/lighting/exposure.h"
#include "render/media/air_box.h"
#include "render/passes/antialias.h"
#include "render/reference/display.h"
#include "render/view/air_lamp.h"
#include "render/view/stopwatch.h"

namespace rubble {

namespace {

ReferenceOptions reference_options(const RenderOptions& o, std::uint64_t seed) {
  ReferenceOptions out;
  out.samples = o.colour.samples, out.denoise = o.colour.denoise, out.jitter = o.antialias;
  out.threads = o.threads, out.seed = seed;
  out.cache_folder = o.cache_folder;
  out.progress = o.image_progress;
  return out;
}

std::vector<float> first_three_of_four(const std::vector<float>& values) {
  std::vector<float> out(values.size() / 4 * 3);
  for (std::size_t i = 0; i < values.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) out[i * 3 + c] = values[i * 4 + c];
  return out;
}

// The largest of each entry of such a table and its neighbours.
std::vector<float> with_neighbours(const std::vector<float>& table) {
  constexpr int kColumns = AirVolume::kColumns, kRows = AirVolume::kRows;
  std::vector<float> out(table.size(), 0.0f);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      for (int y = std::max(0, row - 1); y < std::min(kRows, row + 2); ++y)
        for (int x = std::max(0, column - 1); x < std::min(kColumns, column + 2); ++x) {
          float& most = out[std::size_t(row) * kColumns + std::size_t(column)];
          most = std::max(most, table[std::size_t(y) * kColumns + std::size_t(x)]);
        }
  return out;
}

// For each ray of the air's table, how far away what lies between it and its neighbours is; empty:
// not known.
std::vector<float> farthest_in_air(const ViewRays& view, const std::vector<float>& depth_values, ThreadPool& pool) {
  constexpr int kColumns = AirVolume::kColumns, kRows = AirVolume::kRows;
  const Intrinsics& k = view.intrinsics;
  if (!view.plain() || !AirVolume::has_pixels(k.width, k.height)) return {};
  // The longest ray that reaches unit depth.
  const double x = std::max(k.cx + 0.5, k.width - k.cx) / k.fx,
               y = std::max(k.cy + 0.5, k.height - k.cy) / k.fy;
  const float longest = kNearPlane * float(std::sqrt(1 + x * x + y * y));
  std::vector<float> out(std::size_t(kColumns) * kRows, 0.0f);
  const auto look = [&](int v, int row) {
    for (int column = 0, u = 0; column < kColumns; ++column) {
      const float* at = &depth_values[std::size_t(v) * std::size_t(k.width)];
      float least = 1;
      for (const int end = (column + 1) * k.width / kColumns; u < end; ++u)
        least = std::min(least, at[u]);
      float& far = out[std::size_t(row) * kColumns + std::size_t(column)];
      far = std::max(far, least > 0 ? longest / least : float(AirVolume::kFarthest));
    }
  };
  pool.run(kRows, 2, [&](int begin, int end) {
    for (int row = begin, v = (begin * k.height + kRows - 1) / kRows; row < end; ++row)
      for (; v < k.height && v * kRows / k.height == row; ++v) look(v, row);
  });
  return with_neighbours(out);
}

ViewProjection projection_of(const ViewRays& view) {
  return {view.world_from_camera, view.intrinsics};
}

}  // namespace

ColourDrawer::ColourDrawer(LitScene& scene)
    : scene_(scene) {
  restart();
  if (scene.is_traced())
    reference_ = std::make_unique<ReferencePass>(
        ReferenceSurroundings{scene.scene, scene.light, scene.patterns, scene.ground_map,
                              scene.frame_light.wetness},
        reference_options(scene.options, scene.seed));
}

void ColourDrawer::restart() {
  if (!scene_.is_traced())
    resolve_ = scene_.on_device->make_colour_pass(scene_.frame_light, scene_.ground_map, scene_.patterns);
}

FrameLight ColourDrawer::light_view(const ViewRays& view, DrawnSurfaces& surfaces,
                                    bool drops_drawn) {
  FrameLight light = scene_.frame_light;
  light.world_from_rig = view.world_from_rig ? &*view.world_from_rig : nullptr;
  light.noise = view.noise;
  if (scene_.medium.clear()) return light;
  const AirLamp glow = glow_of(light.lamp, view.lamp_bearer());
  const Air air = scene_.air_at(view.stamp_ns);
  const FogLight* fog = scene_.fog_light();
  const LitAir lit{scene_.air_light(), scene_.resting_light, fog ? &fog->field() : nullptr,
                   air_box(scene_.scene.bounds), scene_.lamp_fog_on_device()};
  // Where the device has the depth alone, it finds that itself.
  std::vector<float> farthest;
  if (!surfaces.on_device_alone() || scene_.scene.glass) farthest = farthest_in_air(view, surfaces.depth_behind(), scene_.pool);
  air_volume_.prepare(view, air, lit, &glow, drops_drawn, farthest);
  light.air = &air_volume_;
  const double turned = air.turned_share(air.fog_asymmetry());
  light.fog = {air.fog({}) * turned, air.fog_height(),
               air.drops() * air.turned_share(Precipitation::kAsymmetry),
               in_box(lit.box, view.lamp_bearer().translation) ? turned : 1, lit.box};
  return light;
}

std::vector<float> ColourDrawer::trace(const ViewRays& view) const {
  return reference_->draw(view, scene_.frame_light.lamp, scene_.air_at(view.stamp_ns));
}

float ColourDrawer::expose(const MeteredImage& metered) const {
  ExposureOptions options = kDisplayExposure;
  options.fixed = scene_.options.fixed_exposure;
  return find_exposure(options, metered);
}

void ColourDrawer::draw_traced(const ViewRays& view, std::optional<float> exposure, ColourImage& image) const {
  const Stopwatch start;
  const Intrinsics& k = view.intrinsics;
  const std::vector<float> radiance = trace(view);
  const Vec3f gains = white_balance(scene_.light);
  image.exposure = exposure ? *exposure : expose(meter_image(radiance, k.width, k.height, gains));
  copy_colours(develop_image(radiance, k.width, k.height, gains, image.exposure), image.rgb);
  image.resolve = start.time();
}

void ColourDrawer::light_shown(DrawnSurfaces& surfaces) {
  if (!scene_.knows_all_light()) scene_.light_pieces(surfaces.shown_pieces());
}

void ColourDrawer::set_bounce(bool shows, DrawnSurfaces& surfaces) {
  if (shows)
    scene_.add_bounce([&] { return surfaces.shown(); });
  else
    scene_.leave_bounce_out();
}

void ColourDrawer::start_shaded(const ViewRays& view, DrawnSurfaces& surfaces,
                                std::optional<float> exposure, StartedColours& out) {
  const Stopwatch start;
  const ViewProjection projection = projection_of(view);
  const SurfaceImages images = surfaces.images();
  if (!exposure && scene_.options.fixed_exposure > 0) exposure = float(scene_.options.fixed_exposure);
  light_shown(surfaces);
  scene_.light_air(view.stamp_ns);
  bool bounce = scene_.aim_lamp(view.lamp_bearer(), view.stamp_ns), metered = false;
  if (bounce && exposure) bounce = scene_.bounce_shows(*exposure);
  // In daylight it hardly ever shows. What the image is like without it tells.
  const bool try_without = bounce && !exposure && scene_.lamp_is_in_the_open();
  set_bounce(bounce && !try_without, surfaces);
  FrameLight light = light_view(view, surfaces, false);
  if (try_without) {
    const float found = resolve_->meter(projection, view.world_from_camera, images, light);
    if (scene_.bounce_shows(found)) {
      set_bounce(true, surfaces);
      light = light_view(view, surfaces, false);
    } else {
      exposure = found, metered = true;
    }
  }
  resolve_->draw(projection, view.world_from_camera, images, light, exposure, metered);
  out.image.resolve = start.time();
  const Stopwatch finish;
  out.coming = resolve_->finish(images, scene_.options.antialias);
  out.image.finish = finish.time();
}

StartedColours ColourDrawer::start(const ViewRays& view, DrawnSurfaces& surfaces, std::optional<float> exposure) {
  scene_.move_to(view.stamp_ns);
  StartedColours out;
  if (reference_)
    draw_traced(view, exposure, out.image);
  else
    start_shaded(view, surfaces, exposure, out);
  return out;
}

ColourImage ColourDrawer::collect(StartedColours started) {
  ColourImage& image = started.image;
  if (!started.coming) return std::move(image);
  const Stopwatch read;
  image.exposure = started.coming->take(image.rgb);
  image.read = read.time();
  return std::move(image);
}

FrameLight ColourDrawer::light_linear(const ViewRays& view, DrawnSurfaces& surfaces) {
  light_shown(surfaces);
  scene_.light_air(view.stamp_ns);
  set_bounce(scene_.aim_lamp(view.lamp_bearer(), view.stamp_ns), surfaces);
  return light_view(view, surfaces, true);
}

std::unique_ptr<LightWatch> ColourDrawer::make_light_watch(const WatchedPixels& pixels) const {
  return resolve_ ? resolve_->make_light_watch(pixels) : nullptr;
}

std::vector<LightChange> ColourDrawer::draw_changes(const ViewRays& view, DrawnSurfaces& surfaces, LightWatch& watch) {
  scene_.move_to(view.stamp_ns);
  const SurfaceImages images = surfaces.images();
  const FrameLight light = light_linear(view, surfaces);
  return resolve_->draw_changes(projection_of(view), view.world_from_camera, images, light, watch);
}

StartedRadiance ColourDrawer::start_radiance(const ViewRays& view, DrawnSurfaces& surfaces) {
  scene_.move_to(view.stamp_ns);
  if (reference_) return {trace(view), nullptr};
  const SurfaceImages images = surfaces.images();
  const FrameLight light = light_linear(view, surfaces);
  return {{}, resolve_->draw_linear(projection_of(view), view.world_from_camera, images, light)};
}

std::vector<float> ColourDrawer::collect(StartedRadiance started) {
  return started.coming ? first_three_of_four(started.coming->take()) : std::move(started.traced);
}

}  // namespace rubble
