// An image stream: one or more values for every pixel of a camera's frames.
//
// Each stream is a file render/streams/NAME.cpp, which describes it and, for ground truth, computes it from the visible
// surface of a pixel. Recorders, hashes, sizes, the keys of missions and the documents read the table of all streams,
// image_streams() in render/streams/image_streams.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "render/scene/image.h"

namespace rubble {

struct Frame;
class SeenSurface;

// Computes a pixel. Pixels without a surface keep ImageStream::nothing.
template <typename T>
using PixelMaker = void (*)(const SeenSurface& seen, T* pixel);

// File type of an image in a folder. png: 8 or 16 bit integers; exr: floats, or 32-bit integers as signed numbers; flo:
// two floats, Middlebury.
enum class ImageFile { png, exr, flo };

struct ImageStream {
  std::string name;     // "normals": in camera.channels, in hashes, of folders
  std::string meaning;  // one sentence, for the documents
  std::string unit;     // "m"; empty: none
  int components = 1;   // values a pixel; range: 1 to 3
  // Computes a pixel; its type is that of the values. monostate: the camera model makes the image, and `of` finds it in
  // a frame.
  std::variant<std::monostate, PixelMaker<std::uint8_t>, PixelMaker<std::uint16_t>,
               PixelMaker<std::uint32_t>, PixelMaker<float>>
      make{};
  double nothing = 0;       // value of pixels without a surface; NaN for floats only
  bool casts_rays = false;  // calls SeenSurface::blocked
  bool needs_next = false;  // calls SeenSurface::in_next_frame: impossible if the next pose is unknown
  bool has_legend = false;  // its values are numbers of pieces or classes
  ImageFile file = ImageFile::exr;  // file type in a folder
  ImageView (*of)(const Frame& frame) = nullptr;  // for images of the camera model

  bool is_truth() const { return make.index() != 0; }  // a valid name of camera.channels
  std::size_t bytes_per_pixel() const;                 // for ground truth
  // Pixel format of ROS: "32FC3", "32SC1", "16UC1", "mono8", "rgb8". For ground truth.
  const char* ros_encoding() const;
  // Values of this many pixels, all `nothing`. For ground truth.
  ImageValues blank(std::size_t pixels) const;
};

}  // namespace rubble
