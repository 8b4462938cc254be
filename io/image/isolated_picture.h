// Pictures that strangers made, decoded in a child process (kernel/base/system/isolated_worker.h).
#pragma once

#include <cstdint>
#include <string>

#include "kernel/base/system/disk_cache.h"
#include "kernel/base/error.h"
#include "kernel/base/system/isolated_worker.h"

namespace rubble {

// Of a picture that is read; more is refused.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::int64_t kMostPixels = std::int64_t(1) << 20;  // or most of the time goes there
#else
inline constexpr std::int64_t kMostPixels = std::int64_t(1) << 28;
#endif

// What `decode` returns: an image with width, height and, as the member `values`, its pixels.
template <typename Image, typename Values, typename Decode>
Image read_isolated_picture(const std::string& path, Values Image::*values, Decode decode) {
  const std::string bytes = run_isolated(path, "picture", [&] {
    const Image image = decode();
    CacheWriter writer;
    writer.put(image.width);
    writer.put(image.height);
    writer.put(image.*values);
    return writer.bytes();
  });
  CacheReader reader(bytes);
  Image image;
  reader.get(image.width);
  reader.get(image.height);
  reader.get(image.*values);
  if (!reader.whole()) throw RunError("a picture was cut short between two processes");
  return image;
}

}  // namespace rubble
