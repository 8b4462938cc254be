#include "render/camera/projection.h"

namespace rubble {

ViewProjection::ViewProjection(const Pose& world_from_camera, const Intrinsics& k)
    : world_from_optical(world_from_camera * camera_from_optical),
      optical_from_world(world_from_optical.inverse()),
      intrinsics(k) {}

std::array<std::array<float, 4>, 3> ViewProjection::clip_rows(const Pose& world_from_mesh,
                                                              double scale) const {
  const Pose optical_from_mesh = optical_from_world * world_from_mesh;
  const Mat3 r = optical_from_mesh.rotation.matrix() * scale;
  const Vec3 t = optical_from_mesh.translation;
  const Intrinsics& k = intrinsics;
  const double sx = 2 * k.fx / k.width, ox = (2 * k.cx + 1) / k.width - 1;
  const double sy = 2 * k.fy / k.height, oy = (2 * k.cy + 1) / k.height - 1;
  const Vec3 x = r.rows[0] * sx + r.rows[2] * ox, y = r.rows[1] * sy + r.rows[2] * oy;
  const Vec3 w = r.rows[2];
  return {{{float(x.x), float(x.y), float(x.z), float(t.x * sx + t.z * ox)},
           {float(y.x), float(y.y), float(y.z), float(t.y * sy + t.z * oy)},
           {float(w.x), float(w.y), float(w.z), float(t.z)}}};
}

}  // namespace rubble
