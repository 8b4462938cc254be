#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "kernel/base/error.h"
#include "render/bake.h"
#include "render/effects/antialias.h"
#include "render/exposure.h"
#include "render/geometry.h"
#include "render/passes/resolve_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/visibility_pass.h"
#include "render/truth.h"

namespace rubble {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void check_intrinsics(const Intrinsics& k) {
  const bool whole = k.width > 0 && k.height > 0 && k.width <= 16384 && k.height <= 16384;
  const bool finite = std::isfinite(k.fx) && std::isfinite(k.fy) && std::isfinite(k.cx) &&
                      std::isfinite(k.cy) && k.fx > 0 && k.fy > 0;
  if (!whole || !finite)
    throw RunError(
        "cannot draw with these intrinsics: width and height must be 1 to 16384, fx and "
        "fy positive, cx and cy finite");
  for (double d : k.distortion)
    if (d != 0) throw RunError("the renderer draws a pinhole image: distortion must be zero");
}

void to_metric_depth(const std::vector<float>& values, std::vector<float>& out) {
  out.resize(values.size());
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < values.size(); ++i)
    out[i] = values[i] > 0 ? kNearPlane / values[i] : none;
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

bool draws_on_processor(const RenderOptions& options, const GlInfo& info) {
  if (options.raster != RasterChoice::automatic) return options.raster == RasterChoice::processor;
  for (const char* software : {"llvmpipe", "softpipe", "swrast"})
    if (info.renderer.find(software) != std::string::npos) return true;
  return false;
}

}  // namespace

struct Renderer::State {
  State(GlContext& c, const Scene& s, const RenderOptions& o, const Progress& progress);

  GlContext& context;
  const Gl& gl;
  RenderOptions options;
  PreparedScene scene;
  LightModel light;
  AirLight air_light;
  GpuGeometry geometry;
  ShadowMap shadow;
  FrameLight frame_light;
  std::unique_ptr<VisibilityPass> visibility;
  std::unique_ptr<ResolvePass> resolve;
  AutoExposure exposure;
  std::int64_t last_stamp_ns = 0;
  RenderTimes times;
  std::vector<std::uint8_t> rgba;
  std::unique_ptr<TruthMaker> truth;

  void update_air(const Pose& world_from_camera);
  void draw_colour(const ViewProjection& view, const Pose& pose);
};

Renderer::State::State(GlContext& c, const Scene& s, const RenderOptions& o,
                       const Progress& progress)
    : context(c),
      gl(c.gl()),
      options(o),
      scene(prepare_scene(s, o.threads)),
      light(make_light_model(s.light)),
      exposure(ExposureOptions{0.17, 0.25, o.fixed_exposure}) {
  const auto report = [&](double fraction) {
    if (progress) progress(fraction);
  };
  report(0.05);
  const DiskCache cache(o.cache_folder);
  const std::vector<PatternImage> patterns = make_patterns_once(cache, o.texture_size, o.threads);
  report(0.15);
  BakedScene baked;
  if (o.bake) {
    BakeOptions bake;
    bake.threads = o.threads;
    bake.rays = o.bake_rays;
    bake.seed = s.seed;
    baked = bake_light_once(cache, scene, light, bake, [&](double f) { report(0.15 + 0.7 * f); });
  } else {
    baked = open_sky_light(scene, light);
  }
  air_light = std::move(baked.air);
  geometry = upload_geometry(gl, scene, baked.vertices);
  report(0.9);
  shadow = draw_shadow_map(gl, scene, geometry, light, o.shadow_size);
  frame_light = {&light, &shadow, s.lamp, s.air, {}};
  visibility = std::make_unique<VisibilityPass>(
      gl, scene, geometry,
      VisibilityOptions{o.occlusion_culling, o.coarse_below, draws_on_processor(o, c.info()),
                        o.threads});
  resolve = std::make_unique<ResolvePass>(gl, geometry, frame_light, patterns);
  truth = std::make_unique<TruthMaker>(scene, geometry, o.threads);
  report(1);
}

void Renderer::State::update_air(const Pose& world_from_camera) {
  if (frame_light.air.fog_density <= 0) return;
  frame_light.air_ambient = air_light.at(Vec3f(world_from_camera.translation));
}

void Renderer::State::draw_colour(const ViewProjection& view, const Pose& pose) {
  const auto start = Clock::now();
  resolve->draw(view, pose, *visibility, frame_light, exposure.factor());
  gl.Finish();
  times.resolve = milliseconds_since(start);
  const auto read_start = Clock::now();
  resolve->read(rgba);
  times.read = milliseconds_since(read_start);
}

Renderer::Renderer(GlContext& context, const Scene& scene, const RenderOptions& options,
                   const Progress& progress) {
  context.make_current();
  state_ = std::make_unique<State>(context, scene, options, progress);
}

Renderer::~Renderer() {
  if (!state_) return;
  try {
    state_->context.make_current();  // so that what it made there can be deleted
  } catch (const RunError&) {
    // Nothing can be deleted without a context; the driver frees it with the context.
  }
}

Frame Renderer::render(const Pose& world_from_camera, const Intrinsics& intrinsics, int index,
                       std::int64_t stamp_ns) {
  State& s = *state_;
  check_intrinsics(intrinsics);
  s.context.make_current();
  const ViewProjection view(world_from_camera, intrinsics);
  const auto start = Clock::now();
  s.visibility->draw(view);
  s.times.visibility = milliseconds_since(start);
  s.times.triangles = s.visibility->counts().triangles;
  s.update_air(world_from_camera);
  // The first frame is metered until the exposure holds.
  constexpr int kMostTries = 4;
  const double elapsed = std::max(0.0, double(stamp_ns - s.last_stamp_ns) * 1e-9);
  const bool first = !s.exposure.settled();
  if (s.options.fixed_exposure > 0) s.exposure.follow(s.rgba, 0, 0, 0);
  s.draw_colour(view, world_from_camera);
  for (int i = 0; first && i < kMostTries && !s.exposure.settled(); ++i) {
    s.exposure.follow(s.rgba, intrinsics.width, intrinsics.height, 0);
    s.draw_colour(view, world_from_camera);
  }
  s.exposure.follow(s.rgba, intrinsics.width, intrinsics.height, first ? 0 : elapsed);
  s.last_stamp_ns = stamp_ns;

  Frame frame;
  frame.index = index;
  frame.stamp_ns = stamp_ns;
  frame.intrinsics = intrinsics;
  frame.world_from_camera = world_from_camera;
  to_metric_depth(s.visibility->depth_values(), frame.depth);
  const auto finish = Clock::now();
  if (s.options.antialias) {
    smooth_edges(s.rgba, s.visibility->depth_values(), intrinsics.width, intrinsics.height,
                 s.options.threads, frame.rgb);
  } else {
    frame.rgb.resize(frame.depth.size() * 3);
    for (std::size_t i = 0; i < frame.depth.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) frame.rgb[i * 3 + k] = s.rgba[i * 4 + k];
  }
  s.times.finish = milliseconds_since(finish);
  return frame;
}

void Renderer::add_channels(const ChannelSet& channels, const Pose* next_world_from_camera,
                            Frame& frame) {
  if (!channels.any()) return;
  State& s = *state_;
  s.context.make_current();
  const std::vector<std::uint32_t> ids = s.visibility->read_ids();
  ViewRays rays{frame.intrinsics, {frame.world_from_camera * camera_from_optical}, nullptr};
  std::vector<Pose> next;
  if (next_world_from_camera) next.push_back(*next_world_from_camera * camera_from_optical);
  const std::vector<float> distances = distances_of(frame.depth, frame.intrinsics);
  s.truth->fill(channels, {rays, ids, distances, std::move(next)}, frame);
}

LinearFrame Renderer::render_linear(const Pose& world_from_camera, const Intrinsics& intrinsics) {
  State& s = *state_;
  check_intrinsics(intrinsics);
  s.context.make_current();
  const ViewProjection view(world_from_camera, intrinsics);
  s.visibility->draw(view);
  s.update_air(world_from_camera);
  const std::vector<float> rgba =
      s.resolve->draw_linear(view, world_from_camera, *s.visibility, s.frame_light);
  const std::vector<std::uint32_t> ids = s.visibility->read_ids();
  LinearFrame out;
  out.width = intrinsics.width, out.height = intrinsics.height;
  to_metric_depth(s.visibility->depth_values(), out.depth);
  for (std::size_t i = 0; i < out.depth.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.rgb.push_back(rgba[i * 4 + k]);
    out.instance.push_back(ids[i * 2] ? s.scene.placed[ids[i * 2] - 1].id : kNoInstance);
  }
  return out;
}

const RenderTimes& Renderer::times() const { return state_->times; }

}  // namespace rubble
