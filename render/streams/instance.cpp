#include "render/scene/seen_surface.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void make_instance(const SeenSurface& seen, std::uint32_t* pixel) { *pixel = seen.instance; }

}  // namespace

ImageStream instance_stream() {
  ImageStream stream;
  stream.name = "instance";
  stream.meaning = "Number of the piece; as a signed number -1: the ground, -2: nothing.";
  stream.make = make_instance;
  stream.nothing = kNoInstance;
  stream.has_legend = true;
  return stream;
}

}  // namespace rubble
