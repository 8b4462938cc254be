#include "render/streams/image_streams.h"

namespace rubble {

ImageStream rgb_right_stream() {
  ImageStream stream;
  stream.name = "rgb_right";
  stream.meaning = "Colour of the right camera of a stereo pair.";
  stream.unit = "";
  stream.components = 3;
  stream.file = ImageFile::png;
  stream.of = [](const Frame& frame) -> ImageView { return &frame.rgb_right; };
  return stream;
}

}  // namespace rubble
