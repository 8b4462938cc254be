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
      "Optical flow: position of the visible point in the next frame, minus its position in this frame; NaN: no "
      "surface, behind the camera in the next frame, or the last frame.";
  stream.unit = "pixel";
  stream.components = 2;
  stream.make = make_flow;
  stream.nothing = std::numeric_limits<double>::quiet_NaN();
  stream.needs_next = true;
  stream.file = ImageFile::flo;
  return stream;
}

}  // namespace rubble
