// What an image stream is: one value or more for every pixel of a camera's frames.
//
// Each is a file render/streams/NAME.cpp that describes it and, where it is ground truth, makes it from
// what a pixel shows. Recorders, hashes, sizes, the keys of missions and the documents read the table
// of all of them, image_streams() in render/streams/image_streams.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "render/scene/image.h"

namespace rubble {

struct Frame;
class SeenSurface;

// Where nothing is seen a pixel keeps ImageStream::nothing.
template <typename T>
using PixelMaker = void (*)(const SeenSurface& seen, T* pixel);

// How a folder of files keeps one image. png: 8 or 16 bit integers; exr: floats, 32-bit integers as
// signed numbers; flo: two floats, Middlebury.
enum class ImageFile { png, exr, flo };

struct ImageStream {
  std::string name;     // "normals": in camera.channels, in hashes, of folders
  std::string meaning;  // one sentence, for the documents
  std::string unit;     // "m"; empty: none
  int components = 1;   // values a pixel; range: 1 to 3
  // Makes a pixel, and with that says the type of the values. monostate: the camera's own model makes
  // the image, and `of` finds it in a frame.
  std::variant<std::monostate, PixelMaker<std::uint8_t>, PixelMaker<std::uint16_t>,
               PixelMaker<std::uint32_t>, PixelMaker<float>>
      make{};
  double nothing = 0;       // value where no surface is seen; NaN only of floats
  bool casts_rays = false;  // calls SeenSurface::blocked
  bool needs_next = false;  // calls SeenSurface::in_next_frame: not where the way ahead is unknown
  bool has_legend = false;  // its numbers are those of pieces or classes
  ImageFile file = ImageFile::exr;  // in a folder of files
  ImageView (*of)(const Frame& frame) = nullptr;  // of what the camera's own model makes

  bool is_truth() const { return make.index() != 0; }  // what camera.channels may name
  std::size_t bytes_per_pixel() const;                 // of truth
  // ROS's name of the pixel format: "32FC3", "32SC1", "16UC1", "mono8", "rgb8". Of truth.
  const char* ros_encoding() const;
  // As many values as that many pixels need, all `nothing`. Of truth.
  ImageValues blank(std::size_t pixels) const;
};

}  // namespace rubble
