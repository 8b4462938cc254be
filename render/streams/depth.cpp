#include "render/streams/image_streams.h"

namespace rubble {

ImageStream depth_stream() {
  ImageStream stream;
  stream.name = "depth";
  stream.meaning = "Planar depth of the surface that is seen; NaN: none.";
  stream.unit = "m";
  stream.components = 1;
  stream.file = ImageFile::exr;
  stream.of = [](const Frame& frame) -> ImageView { return &frame.depth; };
  return stream;
}

}  // namespace rubble
