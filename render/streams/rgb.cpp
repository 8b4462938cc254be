#include "render/streams/image_streams.h"

namespace rubble {

ImageStream rgb_stream() {
  ImageStream stream;
  stream.name = "rgb";
  stream.meaning = "Colour, 8 bits each of red, green and blue.";
  stream.unit = "";
  stream.components = 3;
  stream.file = ImageFile::png;
  stream.of = [](const Frame& frame) -> ImageView { return &frame.rgb; };
  return stream;
}

}  // namespace rubble
