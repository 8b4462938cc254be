#include "render/shading/mip_images.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace rubble {

namespace {

int texels_of(int size, int level) {
  const int side = std::max(1, size >> level);
  return side * side;
}

}  // namespace

PackedImages::PackedImages(const TextureStack& images, int count)
    : size_(images.size()),
      levels_(std::min(images.levels(), int(std::size(MipImages().first_texel)))),
      stride_(0) {
  for (int level = 0; level < levels_; ++level) stride_ += texels_of(size_, level);
  texels_.resize(std::size_t(std::max(count, 1)) * std::size_t(stride_));
  std::uint32_t* at = texels_.data();
  for (int i = 0; i < count; ++i) {
    for (int level = 0; level < levels_; ++level) {
      const std::vector<std::uint8_t>& from = images.texels(i, level);
      std::memcpy(at, from.data(), from.size());
      at += texels_of(size_, level);
    }
  }
}

MipImages PackedImages::view() const {
  MipImages out;
  out.texels = texels_.data(), out.size = size_, out.levels = levels_, out.stride = stride_;
  int first = 0;
  for (int level = 0; level < levels_; ++level)
    out.first_texel[level] = first, first += texels_of(size_, level);
  return out;
}

}  // namespace rubble
