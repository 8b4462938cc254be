// The air in front of the camera, tabled for one frame: how much light passes up to each distance,
// and how much is thrown towards the lens on the way: of the lights and the lamp by the phase function
// of what hangs there, of sky and surfaces, whose light comes from all around, evenly. Reckoned on the processor from the same Medium
// that the depth sensor asks.
#pragma once

#include <array>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/camera/view_rays.h"
#include "render/lighting/bake.h"
#include "render/lighting/lighting.h"
#include "render/media/air_glow.h"
#include "render/media/medium.h"

namespace rubble {

class AirVolume {
 public:
  static constexpr int kColumns = 96, kRows = 96, kSlices = 40;

  // Slice k of the table is at the distance r along the ray with r / (r + 2 m) = k / (kSlices - 1);
  // the last is at infinity, reckoned as kFarthest.
  static constexpr double kFarthest = 300;  // unit: m
  static double slice_distance(int slice);

  // light: what is baked; lights: where its direct part comes from. drops_drawn: without the drops that cameras
  // draw one by one.
  void build(const ViewRays& view, const Air& air, const AirLight& light, const LightSet& lights,
             const AirLamp* lamp, bool drops_drawn, ThreadPool& pool);

  // Red, green, blue (kcd/m2) and transmittance; x runs fastest, then y (rows from the top), then
  // the slice. Rays go through the middles of kColumns by kRows equal rectangles of the image.
  const std::vector<std::array<float, 4>>& table() const { return table_; }

 private:
  void trace(int column, int row);

  std::vector<std::array<float, 4>> table_;
  const ViewRays* view_ = nullptr;
  const Air* air_ = nullptr;
  const AirLight* light_ = nullptr;
  const LightSet* lights_ = nullptr;
  const AirLamp* lamp_ = nullptr;
  bool drops_drawn_ = false;
};

}  // namespace rubble
