// The air in front of the camera, tabled for one frame: how much light passes up to each distance,
// and how much is thrown towards the lens on the way: of the lights and the lamp by the phase function
// of what hangs there, and of all else by the field of LitAir. Found from the same Medium that the depth
// sensor asks, by the processor or, from what is prepared here, by a graphics card.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/camera/view_rays.h"
#include "render/lighting/bake.h"
#include "render/lighting/lighting.h"
#include "render/media/air_glow.h"
#include "render/media/medium.h"
#include "render/media/near_glow.h"
#include "render/shading/wide_shader.h"

namespace rubble {

class AirVolume {
 public:
  static constexpr int kColumns = 96, kRows = 96, kSlices = 40;

  // Slice k of the table is at the distance r along the ray with r / (r + 2 m) = k / (kSlices - 1);
  // the last is at infinity, reckoned as kFarthest.
  static constexpr double kFarthest = 300;  // unit: m
  // Whether each ray of the table has pixels of an image, so that what they show tells how much of it is read.
  static bool has_pixels(int width, int height) { return width >= kColumns && height >= kRows; }
  static double slice_distance(int slice);

  // Before a view. drops_drawn: without the drops that cameras draw one by one. farthest: for each ray of the table, the
  // distance up to which it is read: what lies beyond is left as it was; empty: all of it; unit: m. Baked light is that of
  // the first call. The view and the field of `lit` must stay as they are while the table is asked for.
  void prepare(const ViewRays& view, const Air& air, const LitAir& lit, const AirLamp* lamp, bool drops_drawn,
               const std::vector<float>& farthest);

  // Red, green, blue (kcd/m2) and transmittance; x runs fastest, then y (rows from the top), then
  // the slice. Rays go through the middles of kColumns by kRows equal rectangles of the image. Found when it is first asked
  // for.
  const std::vector<std::array<float, 4>>& table(const WideShader& shader, ThreadPool& pool);

  // What it is found from, without rays and light from all around; and the latter, null: not known.
  const AirTraceData& data() const { return data_; }
  const RadianceGrid* field() const { return field_; }
  std::uint64_t version() const { return version_; }  // another number after each prepare() of any

 private:
  // Light from all around varies little from ray to ray: it is looked up for the middles of 3 by 3 of them, in
  // orders of spherical harmonics.
  static constexpr int kShared = 3;
  using Orders = std::array<float, 6 * kOrders>;  // red, green, blue, and those of the lamp's light

  static Vec3 direction(const ViewRays& view, double column, double row, Vec3& eye);
  void find_rays(const ViewRays& view);
  void find_wanted(const std::vector<float>& farthest);
  void look_around(ThreadPool& pool);
  const NearGlow& near_glow(float cone, double cosine);
  void look_around_ray(int column, int row);

  AirTraceData data_;
  const ViewRays* view_ = nullptr;
  const RadianceGrid* field_ = nullptr;
  std::uint64_t version_ = 0;
  bool found_ = false;  // the table
  std::vector<std::array<float, 4>> table_;
  std::vector<float> rays_;           // as AirTraceData::rays
  std::vector<std::int32_t> wanted_;  // slices of each ray
  std::vector<Orders> around_;        // as the table, of kColumns / kShared by kRows / kShared rays
  std::vector<AirTraceData::Puff> puffs_;
  std::vector<float> baked_radiance_, baked_direct_;  // four numbers a point
  // Of the lamp as it was in the picture before.
  std::optional<NearGlow> near_glow_;
  float near_glow_cone_ = 0;
  double near_glow_cosine_ = 0;
};

}  // namespace rubble
