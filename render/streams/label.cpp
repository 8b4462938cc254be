#include "render/scene/seen_surface.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void make_label(const SeenSurface& seen, std::uint16_t* pixel) { *pixel = seen.label; }

}  // namespace

ImageStream label_stream() {
  ImageStream stream;
  stream.name = "label";
  stream.meaning = "Class of the piece: 0: sky, 1: ground, from 2 on: one class for each asset.";
  stream.make = make_label;
  stream.nothing = kSkyLabel;
  stream.has_legend = true;
  stream.file = ImageFile::png;
  return stream;
}

}  // namespace rubble
