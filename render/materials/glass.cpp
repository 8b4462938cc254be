#include "render/materials/glass.h"

#include "render/materials/surface_appearance.h"

namespace rubble {

std::uint32_t glass_appearance() {
  static const std::uint32_t look = find_surface_appearance(kGlassAppearance);
  return look;
}

}  // namespace rubble
