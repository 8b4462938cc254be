// What one pixel shows: the record of a visible surface that streams of ground truth are made from.
// It answers for one instant and one pixel, and knows nothing of how the image was drawn.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kernel/base/math.h"

namespace rubble {

class SeenSurface {
 public:
  virtual ~SeenSurface() = default;

  int u = 0, v = 0;             // column and row; unit: pixel
  Vec3 point;                   // that is seen, in the world; unit: m
  Pose world_from_optical;      // of the camera when this row was exposed
  std::uint32_t instance = 0;   // piece number; kGroundInstance
  std::uint16_t label = 0;      // class, as in SceneInstance::label

  // Of the triangle, towards the camera, in the world; unit length.
  virtual Vec3 normal() const = 0;
  // Whether a ray, in the world, meets a piece between 0 and `farthest`; unit: m. Only for streams
  // that declare ImageStream::casts_rays.
  virtual bool blocked(const Vec3f& from, const Vec3f& direction, float farthest) const = 0;
  // Column and row where the same point is in the next frame, inside the image or beside it; nothing
  // behind the camera, and where no frame follows. Only with ImageStream::needs_next.
  virtual std::optional<std::array<double, 2>> in_next_frame() const = 0;
};

}  // namespace rubble
