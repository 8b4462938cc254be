// Images with their halved levels in one piece of memory, as the shading on the processor reads
// them.
#pragma once

#include <cstdint>
#include <vector>

#include "render/materials/texture_stack.h"
#include "render/shading/shading_data.h"

namespace rubble {

class PackedImages {
 public:
  PackedImages() = default;
  PackedImages(const TextureStack& images, int count);

  MipImages view() const;

 private:
  std::vector<std::uint32_t> texels_;
  int size_ = 1, levels_ = 1, stride_ = 1;
};

}  // namespace rubble
