// Light by following paths from the camera: unbiased but for rounding. Every pixel is the mean of its
// samples, and a sample the sum over the points of one path of the light that reaches each directly,
// from each lamp, the sun's disc and a point of the sky, and of what the path's end meets. The sky is
// weighed against the chance that the path itself finds it (multiple importance sampling, Veach 1997,
// balance heuristic); lamps seen through air are sampled by equal angles along the ray (Kulla and Fajardo
// 2012); paths end by Russian roulette. At a sheet of glass a path goes straight on as often as light does, and what
// a lamp or the sky sends to a point comes weakened by the sheets on its way.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/geometry/glass_sheets.h"
#include "render/geometry/ray_scene.h"
#include "render/transport/air_path.h"
#include "render/transport/scene_lights.h"
#include "render/transport/surface_model.h"

namespace rubble {

struct TraceOptions {
  int samples = 64;        // a pixel; range: 1 to 65536
  int most_bounces = 128;  // a bound that Russian roulette hardly ever lets a path reach
  bool jitter = true;      // over the pixel's square, which smooths edges; false: its middle
  std::uint64_t seed = 0;  // of all that is random
};

struct TracedScene {
  const RayScene& rays;          // of the finest level, without what is in `sheets`
  const SurfaceModel& surfaces;  // of that scene
  const SceneLights& lights;     // of the place, without the lamp
  const AirPath& air;            // at the instant of the image
  bool surrounded = false;       // as PreparedScene::surrounded
  const GlassSheets* sheets = nullptr;  // of that scene; null: there are none
};

// What is seen, and from where it is lit.
struct TracedView {
  ViewRays rays;                  // one a pixel
  std::vector<PlacedLamp> lamps;  // one, or one a row

  const PlacedLamp& lamp(int row) const {
    return lamps[lamps.size() == 1 ? 0 : std::size_t(row)];
  }
};

// Sums over the samples of one pixel; its features are those of the surface that is seen first.
struct PixelSums {
  Vec3 light;                  // radiance; unit: kcd/m2
  double luminance2 = 0;       // of squares of each sample's luminance
  Vec3f albedo, normal;        // of the surface; normal in the world
  float distance = 0;          // along the ray; unit: m
  std::uint32_t surfaces = 0;  // samples that met one
};

struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;  // unit: pixel
};

class PathTracer {
 public:
  PathTracer(const TracedScene& scene, const TraceOptions& options)
      : scene_(scene), options_(options) {}

  // Rows of the box in turn, into `out`. The same whatever other boxes are traced, and in what order;
  // may be called from several threads.
  void trace(const TracedView& view, const PixelBox& box, std::vector<PixelSums>& out) const;

 private:
  TracedScene scene_;
  TraceOptions options_;
};

}  // namespace rubble
