#include "render/camera/view_rays.h"

#include "kernel/base/parallel.h"

namespace rubble {

std::shared_ptr<const LensDirections> make_lens_directions(const Intrinsics& k, int threads) {
  const Lens lens(k);
  auto out = std::make_shared<LensDirections>(std::size_t(k.width) * std::size_t(k.height));
  parallel_for(std::size_t(k.height), threads, [&](std::size_t v) {
    for (int u = 0; u < k.width; ++u)
      if (const auto d = lens.direction(u, double(v)))
        (*out)[v * std::size_t(k.width) + std::size_t(u)] = Vec3f(*d);
  });
  return out;
}

}  // namespace rubble
