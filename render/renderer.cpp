#include "render/renderer.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/geometry/geometry.h"
#include "render/geometry/ground_map.h"
#include "render/geometry/moving_pieces.h"
#include "render/lighting/bake.h"
#include "render/lighting/exposure.h"
#include "render/lighting/live_light.h"
#include "render/media/air_volume.h"
#include "render/media/medium.h"
#include "render/passes/antialias.h"
#include "render/passes/ground_truth.h"
#include "render/passes/ray_pass.h"
#include "render/passes/resolve_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/visibility_pass.h"
#include "render/reference/display.h"
#include "render/reference/image_key.h"
#include "render/reference/reference_pass.h"
#include "render/transport/lamp_bounce.h"
#include "render/transport/surface_model.h"

namespace rubble {

namespace {

class Stopwatch {
 public:
  PassTime time() const {
    return {std::chrono::duration<double, std::milli>(Clock::now() - start_).count(),
            (processor_seconds() - start_processor_) * 1e3};
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
  }
  Clock::time_point start_ = Clock::now();
  double start_processor_ = processor_seconds();
};

void check_view(const ViewRays& view) {
  const Intrinsics& k = view.intrinsics;
  const bool whole = k.width > 0 && k.height > 0 && k.width <= 16384 && k.height <= 16384;
  const bool finite = std::isfinite(k.fx) && std::isfinite(k.fy) && std::isfinite(k.cx) &&
                      std::isfinite(k.cy) && k.fx > 0 && k.fy > 0;
  if (!whole || !finite)
    throw RunError(
        "cannot draw with these intrinsics: width and height must be 1 to 16384, fx and "
        "fy positive, cx and cy finite");
  if (!view.directions && !Lens(k).is_pinhole())
    throw RunError("without a table of directions the lens must be a pinhole: distortion zero");
}

ViewRays pinhole_view(const Pose& world_from_camera, const Intrinsics& k, std::int64_t stamp_ns) {
  return {stamp_ns, k, world_from_camera};
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

float most_gloss(const PreparedScene& scene) {
  float most = 0;
  for (const PreparedMesh& mesh : scene.meshes)
    for (const PreparedTriangle& t : mesh.triangles)
      most = std::max(most, mirrored_peak(all_surface_appearances()[t.material]));
  return most;
}

ReferenceOptions reference_options(const RenderOptions& o, std::uint64_t seed) {
  ReferenceOptions out;
  out.samples = o.colour.samples, out.denoise = o.colour.denoise, out.jitter = o.antialias;
  out.threads = o.threads, out.seed = seed;
  out.cache_folder = o.cache_folder;
  out.progress = o.image_progress;
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
  GroundMap ground_map;
  MovingPieces moving;
  LightSet light;
  AirLight air_light;
  Medium medium;
  AirVolume air_volume;
  std::int64_t start_ns;
  std::uint64_t seed;
  ThreadPool pool;
  GpuGeometry geometry;
  std::unique_ptr<ShadowPass> shadow;
  std::unique_ptr<LiveLight> live_light;  // where something moves
  std::vector<BakedLight> baked_nodes;    // of what rests; empty where something moves
  BakeLinks links;                        // of the same, until the lamp first needs them
  std::unique_ptr<LampBounce> lamp_bounce;  // made when a lamp is first lit
  bool bounced = false;                   // the device holds light of the lamp too
  FrameLight frame_light;
  std::unique_ptr<VisibilityPass> visibility;
  std::unique_ptr<ResolvePass> resolve;
  std::unique_ptr<ReferencePass> reference;  // none: colours are the resolve pass's
  float exposure = 0.1f;  // of the frame drawn last
  RenderTimes times;
  std::vector<std::uint8_t> rgba;
  std::unique_ptr<GroundTruthMaker> ground_truth;
  std::unique_ptr<RayPass> rays;  // made when a view first needs it
  ViewRays drawn;                 // what was drawn last

  BakedScene bake(const DiskCache& cache, const std::vector<PatternImage>& patterns, const Scene& s,
                  const Progress& report);
  void move_to(std::int64_t stamp_ns);
  void update_air(const ViewRays& view);
  void light_by_lamp(const ViewRays& view);
  // Which triangle each pixel shows: by rasterising where that will do, by casting rays otherwise.
  SurfaceImages draw_surfaces(const ViewRays& view);
  // metered: at the exposure that the view itself asks for; otherwise at that of the frame before.
  void draw_colour(const SurfaceImages& surfaces, bool metered);
  void draw_reference_colour(bool metered);
  std::vector<float> trace_light() const;  // of the view drawn last; 3 floats a pixel, kcd/m2
  ViewProjection projection() const { return {drawn.world_from_camera, drawn.intrinsics}; }
  // Of the view drawn last.
  const std::vector<float>& depth_values() const;
  std::vector<float> planar_depth() const;
  std::vector<float> distances() const;
  std::vector<std::uint32_t> read_ids() const;
  std::vector<std::uint8_t> finish_colour() const;
};

Renderer::State::State(GlContext& c, const Scene& s, const RenderOptions& o,
                       const Progress& progress)
    : context(c),
      gl(c.gl()),
      options(o),
      scene(prepare_scene(s, o.threads)),
      ground_map(make_ground_map(scene)),
      moving(s, scene),
      light(make_lights(s)),
      medium(s.air, s.seed),
      start_ns(s.start_ns),
      seed(s.seed),
      pool(std::max(1, o.threads)) {
  const auto report = [&](double fraction) {
    if (progress) progress(fraction);
  };
  report(0.05);
  const DiskCache cache(o.cache_folder);
  const std::vector<PatternImage> patterns = make_patterns_once(cache, o.texture_size, o.threads);
  report(0.15);
  BakedScene baked = bake(cache, patterns, s, [&](double f) { report(0.15 + 0.7 * f); });
  air_light = std::move(baked.air);
  links = std::move(baked.links);
  geometry = upload_geometry(gl, scene, baked.nodes);
  if (moving.any())
    live_light = std::make_unique<LiveLight>(scene, light, std::move(baked.nodes), o.threads);
  else
    baked_nodes = std::move(baked.nodes);
  report(0.9);
  shadow = std::make_unique<ShadowPass>(gl, scene, geometry, light, o.shadow_size);
  shadow->draw_moving();  // nothing yet
  frame_light = {&light, &shadow->map(), s.lamp, medium.clear(), s.wetness, most_gloss(scene)};
  visibility = std::make_unique<VisibilityPass>(
      gl, scene, geometry,
      VisibilityOptions{o.occlusion_culling, o.coarse_below, draws_on_processor(o, c.info()),
                        o.threads});
  resolve = std::make_unique<ResolvePass>(gl, geometry, frame_light, ground_map, patterns);
  if (o.colour.quality == RenderQuality::reference)
    reference = std::make_unique<ReferencePass>(
        ReferenceSurroundings{scene, light, patterns, ground_map, s.wetness},
        reference_options(o, s.seed));
  ground_truth = std::make_unique<GroundTruthMaker>(scene, geometry, o.threads);
  report(1);
}

// What rests. Of a still scene that is all of it.
BakedScene Renderer::State::bake(const DiskCache& cache, const std::vector<PatternImage>& patterns,
                                 const Scene& s, const Progress& report) {
  std::vector<std::uint32_t> first_light;  // in the whole scene, of each piece that rests
  const PreparedScene resting = moving.any() ? resting_part(scene, first_light) : PreparedScene();
  const PreparedScene& part = moving.any() ? resting : scene;
  BakedScene baked;
  if (options.bake && options.colour.quality == RenderQuality::fast) {
    BakeOptions bake;
    bake.threads = options.threads;
    bake.rays = options.bake_rays;
    bake.seed = seed;
    const LookSurfaces surfaces(part, patterns, ground_map, s.wetness);
    const auto albedo = [&](const RayScene::Triangle& triangle, float u, float v) {
      constexpr float kMeanOver = 0.1f;  // unit: m
      SurfacePoint point;
      surfaces.find({triangle, u, v, {0, 0, -1}, kMeanOver}, point);
      return mean_albedo(point.reflection);
    };
    baked = bake_light_once(cache, part, light, albedo,
                            surroundings_key({part, light, patterns, ground_map, s.wetness}), bake, report);
  } else {
    baked = open_sky_light(part, light);
  }
  if (!moving.any()) return baked;
  std::vector<BakedLight> nodes(scene.light_nodes);
  for (std::size_t i = 0; i < part.placed.size(); ++i) {
    const std::size_t count = part.meshes[part.placed[i].mesh].light_nodes.size();
    std::copy_n(baked.nodes.begin() + part.placed[i].first_light, count, nodes.begin() + first_light[i]);
  }
  baked.nodes = std::move(nodes);
  return baked;
}

void Renderer::State::move_to(std::int64_t stamp_ns) {
  if (!moving.move_to(stamp_ns)) return;
  update_poses(gl, scene, geometry);
  if (reference) return;  // it follows the scene itself
  update_light(gl, geometry, live_light->update());
  shadow->draw_moving();
}

void Renderer::State::update_air(const ViewRays& view) {
  const Pose& pose = view.lamp_bearer();
  if (medium.clear() || reference) return;
  const LampSpec& lamp = frame_light.lamp;
  AirLamp glow;
  glow.position = Vec3f(pose * lamp.position);
  glow.axis = Vec3f(pose.rotation.rotate({1, 0, 0}));
  glow.colour = lamp.on ? lamp_colour(lamp) : Vec3f();
  glow.cone = float(1 / (1 - portable::cos(0.5 * lamp.cone_deg * portable::kPi / 180)));
  glow.size2 = float(std::max(lamp.shape == LampShape::point ? 0.0 : 0.25 * lamp.size * lamp.size, 1e-4));
  const Air air = medium.at(double(view.stamp_ns - start_ns) * 1e-9);
  air_volume.build(view, air, air_light, light, &glow, pool);
  frame_light.air_table = &air_volume;
}

// The light that the lamp sends by way of surfaces comes to the baked one.
void Renderer::State::light_by_lamp(const ViewRays& view) {
  const LampSpec& lamp = frame_light.lamp;
  const bool lit = lamp.on && lamp.intensity_cd > 0 && !reference && (lamp_bounce || !links.albedos.empty());
  const std::vector<BakedLight>& base = live_light ? live_light->light() : baked_nodes;
  if (!lit && !bounced) return;
  bounced = lit;
  if (!lit) return update_light(gl, geometry, base);
  if (!lamp_bounce) {
    std::vector<std::uint32_t> first_point;
    std::uint32_t next = 0;
    for (const PlacedMesh& piece : scene.placed) {
      first_point.push_back(piece.moves ? LampBounce::kNoPoints : next);
      if (!piece.moves) next += std::uint32_t(scene.meshes[piece.mesh].bake_points.size());
    }
    lamp_bounce = std::make_unique<LampBounce>(scene, std::move(links), std::move(first_point), options.threads);
    links = BakeLinks();
  }
  const PlacedLamp placed = place_lamp(lamp, lamp_colour(lamp), view.lamp_bearer());
  const Air air = medium.at(double(view.stamp_ns - start_ns) * 1e-9);
  const float extinction = air.clear() ? 0 : float(air.extinction(Vec3(placed.position)));
  update_light(gl, geometry, lamp_bounce->add_to(base, placed, extinction));
}

SurfaceImages Renderer::State::draw_surfaces(const ViewRays& view) {
  const Stopwatch start;
  drawn = view;
  frame_light.world_from_rig = drawn.world_from_rig ? &*drawn.world_from_rig : nullptr;
  move_to(drawn.stamp_ns);
  update_air(drawn);
  light_by_lamp(drawn);
  if (view.plain()) {
    visibility->draw(projection());
    times.triangles = visibility->counts().triangles;
    times.visibility = start.time();
    return {visibility->ids(), visibility->depth(), visibility->depth_values()};
  }
  if (!rays) rays = std::make_unique<RayPass>(gl, scene, geometry, options.threads);
  rays->draw(view);
  times.visibility = start.time();
  return {rays->ids(), rays->depth(), rays->depth_values(), &rays->lens_rays(), &rays->row_poses()};
}

std::vector<float> Renderer::State::trace_light() const {
  return reference->draw(drawn, frame_light.lamp,
                         medium.at(double(drawn.stamp_ns - start_ns) * 1e-9));
}

void Renderer::State::draw_reference_colour(bool metered) {
  const Stopwatch start;
  const Intrinsics& k = drawn.intrinsics;
  const std::vector<float> rgb = trace_light();
  const Vec3f gains = white_balance(light);
  if (metered)
    exposure = find_exposure({0.21, options.fixed_exposure}, meter_image(rgb, k.width, k.height, gains));
  rgba = develop_image(rgb, k.width, k.height, gains, exposure);
  times.resolve = start.time();
  times.read = PassTime();
}

void Renderer::State::draw_colour(const SurfaceImages& surfaces, bool metered) {
  if (reference) return draw_reference_colour(metered);
  const Stopwatch start;
  const Pose& pose = drawn.world_from_camera;
  const bool automatic = metered && options.fixed_exposure <= 0;
  const ExposureOptions wanted{0.21, options.fixed_exposure};
  if (metered)
    exposure = find_exposure(
        wanted, automatic ? resolve->meter(projection(), pose, surfaces, frame_light) : MeteredImage());
  resolve->draw(projection(), pose, surfaces, frame_light, exposure, automatic);
  gl.Finish();
  times.resolve = start.time();
  const Stopwatch read_start;
  resolve->read(rgba);
  times.read = read_start.time();
}

const std::vector<float>& Renderer::State::depth_values() const {
  return drawn.plain() ? visibility->depth_values() : rays->depth_values();
}

std::vector<float> Renderer::State::planar_depth() const {
  std::vector<float> out;
  if (drawn.plain())
    to_metric_depth(visibility->depth_values(), out);
  else
    out = rays->planar_depth();
  return out;
}

std::vector<float> Renderer::State::distances() const {
  return drawn.plain() ? distances_of(planar_depth(), drawn.intrinsics) : rays->distances();
}

std::vector<std::uint32_t> Renderer::State::read_ids() const {
  return drawn.plain() ? visibility->read_ids() : rays->id_values();
}

std::vector<std::uint8_t> Renderer::State::finish_colour() const {
  std::vector<std::uint8_t> rgb;
  const Intrinsics& k = drawn.intrinsics;
  if (options.antialias && !reference) {
    smooth_edges(rgba, depth_values(), k.width, k.height, options.threads, rgb);
    return rgb;
  }
  rgb.resize(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) rgb[i * 3 + c] = rgba[i * 4 + c];
  return rgb;
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

void Renderer::restart(const LampSpec& lamp, const AirSpec& air) {
  State& s = *state_;
  s.context.make_current();
  s.medium = Medium(air, s.seed);
  s.frame_light.lamp = lamp;
  s.frame_light.clear_air = s.medium.clear();
  s.frame_light.air_table = nullptr;
  const DiskCache cache(s.options.cache_folder);
  s.resolve = std::make_unique<ResolvePass>(
      s.gl, s.geometry, s.frame_light, s.ground_map,
      make_patterns_once(cache, s.options.texture_size, s.options.threads));
}

Frame Renderer::render(const Pose& world_from_camera, const Intrinsics& intrinsics, int index,
                       std::int64_t stamp_ns) {
  return render(pinhole_view(world_from_camera, intrinsics, stamp_ns), index);
}

Frame Renderer::render(const ViewRays& view, int index) {
  State& s = *state_;
  check_view(view);
  s.context.make_current();
  const Intrinsics& k = view.intrinsics;
  const SurfaceImages surfaces = s.draw_surfaces(view);
  s.draw_colour(surfaces, true);

  Frame frame;
  frame.index = index;
  frame.stamp_ns = view.stamp_ns;
  frame.intrinsics = k;
  frame.world_from_camera = view.world_from_camera;
  const Stopwatch finish;
  frame.depth = s.planar_depth();
  frame.rgb = s.finish_colour();
  s.times.finish = finish.time();
  return frame;
}

void Renderer::add_truth(const StreamSet& streams, const ViewRays* next, Frame& frame) {
  if (streams.empty()) return;
  State& s = *state_;
  s.context.make_current();
  const std::vector<std::uint32_t> ids = s.read_ids();
  const std::vector<float> distances = s.distances();
  DrawnView view{s.drawn, ids, distances, next};
  const bool follows = std::any_of(streams.begin(), streams.end(),
                                   [](const ImageStream* stream) { return stream->needs_next; });
  if (next && follows) view.shift = s.moving.shift_to(next->stamp_ns);
  s.ground_truth->fill(streams, view, frame);
}

std::vector<Vec3f> Renderer::shifts(std::int64_t stamp_ns) const {
  const State& s = *state_;
  if (!s.moving.any()) return {};
  const std::vector<std::uint32_t> ids = s.read_ids();
  const std::vector<float> distances = s.distances();
  return s.ground_truth->shifts({s.drawn, ids, distances, nullptr, s.moving.shift_to(stamp_ns)});
}

LinearFrame Renderer::render_linear(const Pose& world_from_camera, const Intrinsics& intrinsics) {
  return render_linear(pinhole_view(world_from_camera, intrinsics, 0));
}

LinearFrame Renderer::render_linear(const ViewRays& view) {
  State& s = *state_;
  check_view(view);
  s.context.make_current();
  const SurfaceImages surfaces = s.draw_surfaces(view);
  const std::vector<float> rgba =
      s.reference ? s.trace_light()
                  : s.resolve->draw_linear(s.projection(), s.drawn.world_from_camera, surfaces, s.frame_light);
  const std::size_t channels = s.reference ? 3 : 4;
  const std::vector<std::uint32_t> ids = s.read_ids();
  LinearFrame out;
  out.width = view.intrinsics.width, out.height = view.intrinsics.height;
  out.depth = s.planar_depth();
  out.distance = s.distances();
  out.rgb.resize(out.depth.size() * 3);
  out.instance.resize(out.depth.size());
  for (std::size_t i = 0; i < out.depth.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) out.rgb[i * 3 + c] = rgba[i * channels + c];
    out.instance[i] = ids[i * 2] ? s.scene.placed[ids[i * 2] - 1].id : kNoInstance;
  }
  return out;
}

std::vector<std::uint8_t> Renderer::render_stereo_right(const ViewRays& view) {
  State& s = *state_;
  check_view(view);
  s.context.make_current();
  s.draw_colour(s.draw_surfaces(view), false);
  return s.finish_colour();
}

std::vector<float> Renderer::distances() const { return state_->distances(); }

std::vector<std::uint8_t> Renderer::line_of_sight_mask(const Vec3& place_in_camera) {
  State& s = *state_;
  const std::vector<std::uint32_t> ids = s.read_ids();
  const std::vector<float> distances = s.distances();
  return s.ground_truth->line_of_sight_mask({s.drawn, ids, distances, nullptr}, place_in_camera);
}

std::vector<float> Renderer::albedos() const {
  const std::vector<std::uint32_t> ids = state_->read_ids();
  const std::vector<float> distances = state_->distances();
  return state_->ground_truth->albedos({state_->drawn, ids, distances, nullptr});
}

const RenderTimes& Renderer::times() const { return state_->times; }

}  // namespace rubble
