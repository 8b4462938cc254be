// Ray casting against the pieces. Internal to render/.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/geometry/geometry.h"

namespace rubble {

class RayScene {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Triangle {
    std::uint32_t placed;  // which placed mesh
    std::uint32_t source;  // its triangle in the prepared mesh
  };
  struct Hit {
    std::uint32_t triangle = kNone;  // index into triangles()
    float distance = 0;
    bool back = false;  // from inside
  };

  enum class Detail { coarsest, finest };  // which level of each piece

  explicit RayScene(const PreparedScene& scene, Detail detail = Detail::coarsest);
  ~RayScene();

  // May be called from several threads.
  Hit cast(const Vec3f& from, const Vec3f& direction, float nearest, float farthest) const;
  bool blocked(const Vec3f& from, const Vec3f& direction, float nearest, float farthest) const;
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  std::vector<Triangle> triangles_;
};

}  // namespace rubble
