#include "render/streams/image_streams.h"

namespace rubble {

ImageStream measured_depth_stream() {
  ImageStream stream;
  stream.name = "measured_depth";
  stream.meaning = "Planar depth as the depth sensor measures it; NaN: no return.";
  stream.unit = "m";
  stream.components = 1;
  stream.file = ImageFile::exr;
  stream.of = [](const Frame& frame) -> ImageView { return &frame.measured_depth; };
  return stream;
}

}  // namespace rubble
