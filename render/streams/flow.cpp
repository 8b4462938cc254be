#include <limits>

#include "render/scene/seen_surface.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void make_flow(const SeenSurface& seen, float* pixel) {
  const auto next = seen.in_next_frame();
  if (!next) return;
  pixel[0] = float((*next)[0] - double(seen.u));
  pixel[1] = float((*next)[1] - seen.v);
}

}  // namespace

ImageStream flow_stream() {
  ImageStream stream;
  stream.name = "flow";
  stream.meaning =
      "Optical flow: where the point seen here is in the next frame, less where it is; NaN: no "
      "surface, behind the camera then, or the last frame.";
  stream.unit = "pixel";
  stream.components = 2;
  stream.make = make_flow;
  stream.nothing = std::numeric_limits<double>::quiet_NaN();
  stream.needs_next = true;
  stream.file = ImageFile::flo;
  return stream;
}

}  // namespace rubble
