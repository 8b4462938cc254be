// Pictures that strangers made, decoded in a child process (kernel/base/system/isolated_worker.h). For the library
// alone; others take picture_importer.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "kernel/base/error.h"

namespace rubble {

struct RgbImage;
struct DepthImage;
struct ExrImage;

// Of a picture that is read; more is refused.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::int64_t kMostPixels = std::int64_t(1) << 20;  // or most of the time goes there
#else
inline constexpr std::int64_t kMostPixels = std::int64_t(1) << 28;
#endif

// Between two processes: an image with width, height and, as the member `values`, its pixels.
template <typename Image, typename Values>
std::string pack_picture(const Image& image, Values Image::*values) {
  CacheWriter writer;
  writer.put(image.width);
  writer.put(image.height);
  writer.put(image.*values);
  return writer.bytes();
}

template <typename Image, typename Values>
Image unpack_picture(const std::string& bytes, Values Image::*values) {
  CacheReader reader(bytes);
  Image image;
  reader.get(image.width);
  reader.get(image.height);
  reader.get(image.*values);
  if (!reader.whole()) throw RunError("a picture was cut short between two processes");
  return image;
}

// What the child of a PictureImporter does. Throw InputError.
RgbImage import_rgb_png(const std::string& path);
DepthImage import_depth_png(const std::string& path);
ExrImage import_exr(const std::string& path, const std::vector<std::string>& channels);

}  // namespace rubble
