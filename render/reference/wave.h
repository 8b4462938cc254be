// Paths that are followed together, segment by segment, so that their rays are cast in packets.
// Internal to PathTracer.
#pragma once

#include <cstdint>
#include <vector>

#include "render/reference/path_tracer.h"

namespace rubble {

struct Path {
  std::uint32_t pixel = 0;           // in the box
  std::uint32_t sample = 0;          // of its pixel
  SampleSequence numbers;            // its random numbers
  const PlacedLamp* lamp = nullptr;  // of its row; null: none
  Vec3f from, direction;             // of its next segment, in the world; unit: m; unit length
  float nearest = 0;                 // where the segment begins, so that it leaves its own surface; unit: m
  float spread = 0;                  // width of what the ray stands for, a metre on; unit: m/m
  float density = 0;                 // with which the direction was drawn; 0: the camera's own; unit: 1/sr
  Vec3f throughput{1, 1, 1};         // share of the light at its end that reaches the camera
  Vec3f light;                       // so far; unit: kcd/m2
  int bounces = 0;                   // so far
  int sheets = 0;                    // of glass that it has gone straight through so far
  float air_from = 0;                // so far from `from` the air was met already; unit: m
  bool met_surface = false;          // or only air and sky
  Vec3f albedo, normal;              // where a surface was first met
  float first_distance = 0;          // from the camera to that surface; unit: m
};

class Wave {
 public:
  Wave(const TracedScene& scene, const TracedView& view, const TraceOptions& options);

  // Samples [first, last) of every pixel of the box.
  void begin(const PixelBox& box, int first, int last);
  // One segment of every path that still goes on; false: none does.
  bool step();
  const std::vector<Path>& paths() const { return paths_; }

 private:
  enum Use { kLens, kLight, kSky, kReflect, kChoices, kAir, kAlong, kUses };
  struct Met {  // what a segment ends at
    RayScene::PreciseHit hit;
    bool sheet = false;  // it is of a sheet of glass
  };
  struct Shadow {
    std::uint32_t path;
    Vec3f light;  // added where nothing is in the way
  };
  struct ShadowList {
    std::vector<RayScene::Ray> rays;
    std::vector<Shadow> shadows;
  };

  SamplePair draw(const Path& path, Use use) const;
  bool aim(Path& path, int u, int v);
  void cast(RayScene::Order order);
  void pass_backs(std::size_t active);
  Met met(std::size_t active) const;
  // Each returns whether the path goes on.
  bool follow(std::uint32_t index, const Met& met);
  bool leave(Path& path);
  bool scatter_in_air(std::uint32_t index, float at);
  bool reflect(std::uint32_t index, const Met& met);
  bool pass_sheet(Path& path, const Vec3f& share, float distance) const;
  bool survive(Path& path, float random);

  void light_air_along(std::uint32_t index, float near, float far);
  void light_air(std::uint32_t index, const Vec3f& p);
  void light_surface(std::uint32_t index, const SurfacePoint& surface, const Vec3f& out);
  void ask(std::uint32_t index, std::size_t list, const Vec3f& from, const Vec3f& to_light,
           float distance, const Vec3f& light);
  void answer(ShadowList& list, RayScene::Order order);
  Vec3f passed(RayScene::Ray ray) const;  // share of a light that comes through glass

  const TracedScene& scene_;
  const TracedView& view_;
  const TraceOptions& options_;
  bool first_ = true;  // the next step is the camera's
  std::vector<Path> paths_;
  std::vector<std::uint32_t> active_, next_;
  std::vector<RayScene::Ray> rays_;
  std::vector<RayScene::PreciseHit> hits_;
  std::vector<ShadowList> towards_;  // the camera's surfaces, by light; the last: all else
  std::vector<std::uint8_t> hidden_;
};

}  // namespace rubble
