#include <limits>

#include "render/scene/seen_surface.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void make_normal(const SeenSurface& seen, float* pixel) {
  const Vec3 normal = seen.world_from_optical.rotation.conjugate().rotate(seen.normal());
  for (int i = 0; i < 3; ++i) pixel[i] = float(normal[i]);
}

}  // namespace

ImageStream normals_stream() {
  ImageStream stream;
  stream.name = "normals";
  stream.meaning =
      "Unit normal of the surface, towards the camera, in the optical frame (X right, Y down, Z "
      "forward); NaN: no surface.";
  stream.components = 3;
  stream.make = make_normal;
  stream.nothing = std::numeric_limits<double>::quiet_NaN();
  return stream;
}

}  // namespace rubble
