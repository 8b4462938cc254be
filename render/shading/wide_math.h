// Functions and vectors of lanes, and the models of surfaces, of tone and of fog for them.
#pragma once

#include "render/geometry/wide.h"

namespace rubble::RUBBLE_ISA {

#include "render/surface/real_math.inl"

#define FN RUBBLE_INLINE
#include "render/shaders/surface_model.glsl"
#include "render/shaders/tone.glsl"
#include "render/shaders/fog_depth.glsl"
#undef FN

}  // namespace rubble::RUBBLE_ISA
