#include "render/reference/reference_pass.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

#include "kernel/base/system/disk_cache.h"
#include "kernel/base/parallel.h"
#include "render/media/air_box.h"
#include "render/colour/frame_light.h"
#include "render/reference/denoise.h"
#include "render/reference/image_key.h"
#include "render/reference/tile_journal.h"

namespace rubble {

namespace {

constexpr int kTile = 32;  // side; unit: pixel
constexpr char kKind[] = "reference_image";

std::vector<float> flatten(const std::vector<Vec3f>& light) {
  std::vector<float> out;
  out.reserve(light.size() * 3);
  for (const Vec3f& v : light) out.insert(out.end(), {v.x, v.y, v.z});
  return out;
}

}  // namespace

struct ReferencePass::State {
  State(const ReferenceSurroundings& s, const ReferenceOptions& o)
      : options(o),
        scene(s.scene),
        box(air_box(s.scene.bounds)),
        rays(s.scene, RayScene::Detail::finest, RayScene::Part::solid),
        sheets(s.scene),
        surfaces(s.scene, s.patterns, s.ground, s.wetness),
        place_lights(s.lights),
        lights(s.lights),
        cache(o.cache_folder),
        key(o.cache_folder.empty() ? "" : surroundings_key(s)) {}

  ReferenceOptions options;
  const PreparedScene& scene;
  Aabb box;
  RayScene rays;
  GlassSheets sheets;
  LookSurfaces surfaces;
  const LightSet& place_lights;
  SceneLights lights;  // those, as they are now
  DiskCache cache;
  std::string key;

  std::vector<float> trace(const TracedView& view, const Air& air, TileJournal& journal) const;
};

// Tiles on all threads; only the calling one reports, and stops the rest when that throws.
std::vector<float> ReferencePass::State::trace(const TracedView& view, const Air& air,
                                               TileJournal& journal) const {
  const int width = view.rays.intrinsics.width, height = view.rays.intrinsics.height;
  const AirPath air_path(air, box);
  TraceOptions trace;
  trace.samples = options.samples, trace.jitter = options.jitter;
  trace.seed = options.seed ^ std::uint64_t(view.rays.stamp_ns) * 0x9e3779b97f4a7c15u;
  const PathTracer tracer({rays, surfaces, lights, air_path, scene.surrounded, &sheets}, trace);
  const std::vector<PixelBox> boxes = cut_into_boxes(width, height, kTile);
  std::vector<PixelSums> sums(std::size_t(width) * std::size_t(height));
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(boxes.size(), options.threads, [&](std::size_t i) {
    if (stopped) return;
    const PixelBox& b = boxes[i];
    std::vector<PixelSums> tile;
    if (const auto* known = journal.find(std::uint32_t(i), std::size_t(b.width) * std::size_t(b.height))) {
      tile = *known;
    } else {
      tracer.trace(view, b, tile);
      journal.note(std::uint32_t(i), tile);
    }
    for (int y = 0; y < b.height; ++y)
      std::copy_n(tile.begin() + std::ptrdiff_t(y) * b.width, b.width,
                  sums.begin() + std::ptrdiff_t(b.y + y) * width + b.x);
    ++done;
    if (!options.progress || std::this_thread::get_id() != caller) return;
    try {
      options.progress(double(done) / double(boxes.size()));
    } catch (...) {
      stopped = true;
      throw;
    }
  });
  const TracedImage image = average_samples(sums, width, height, options.samples);
  return flatten(options.denoise ? denoise_image(image, options.threads) : image.light);
}

ReferencePass::ReferencePass(const ReferenceSurroundings& surroundings,
                             const ReferenceOptions& options)
    : state_(std::make_unique<State>(surroundings, options)) {}

ReferencePass::~ReferencePass() = default;

std::vector<float> ReferencePass::draw(const ViewRays& view, const LampSpec& lamp, const Air& air) {
  State& s = *state_;
  s.rays.follow();
  s.sheets.follow();
  s.surfaces.follow();
  if (s.place_lights.carried > 0) s.lights = SceneLights(s.place_lights);
  std::string key;
  const std::size_t size = std::size_t(view.intrinsics.width) * std::size_t(view.intrinsics.height) * 3;
  if (!s.key.empty()) {
    key = image_key(s.key, s.scene, s.place_lights, s.options, view, lamp, air);
    if (const auto bytes = s.cache.find(kKind, key)) {
      std::vector<float> known;
      CacheReader reader(*bytes);
      reader.get(known);
      if (reader.whole() && known.size() == size) return known;
    }
  }
  TracedView traced{view, {}};
  const Pose camera_from = camera_from_optical.inverse();
  for (int row = 0; row < (view.row_poses.empty() ? 1 : view.intrinsics.height); ++row) {
    const Pose camera = view.row_poses.empty() ? view.world_from_camera : view.pose(row) * camera_from;
    const Pose bearer = view.world_from_rig
                            ? camera * (view.world_from_camera.inverse() * *view.world_from_rig)
                            : camera;
    traced.lamps.push_back(place_lamp(lamp, lamp_colour(lamp), bearer));
  }
  TileJournal journal(key.empty() ? "" : s.options.cache_folder + "/reference_tiles", key);
  const std::vector<float> out = s.trace(traced, air, journal);
  if (!key.empty()) {
    CacheWriter writer;
    writer.put(out);
    s.cache.store(kKind, key, writer.bytes());
    journal.remove();
  }
  return out;
}

}  // namespace rubble
