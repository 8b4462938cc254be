// Which surfaces are sheets of glass. How much a pane mirrors and passes: shaders/surface_model.glsl.
#pragma once

#include <cstdint>

namespace rubble {

inline constexpr const char* kGlassAppearance = "glass";  // the look that is clear
std::uint32_t glass_appearance();                          // its index into all_surface_appearances()

}  // namespace rubble
