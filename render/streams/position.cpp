#include <limits>

#include "render/scene/seen_surface.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void make_position(const SeenSurface& seen, float* pixel) {
  for (int i = 0; i < 3; ++i) pixel[i] = float(seen.point[i]);
}

}  // namespace

ImageStream position_stream() {
  ImageStream stream;
  stream.name = "position";
  stream.meaning =
      "Scene coordinates: position of the visible point in the world (X, Y, Z up), for relocalisation and "
      "scores of maps; NaN: no surface.";
  stream.unit = "m";
  stream.components = 3;
  stream.make = make_position;
  stream.nothing = std::numeric_limits<double>::quiet_NaN();
  return stream;
}

}  // namespace rubble
