// The albedos that the bake takes: those that are drawn.
#pragma once

#include "render/lighting/bake.h"
#include "render/transport/surface_model.h"

namespace rubble {

// The surfaces must outlive it.
AlbedoAt drawn_albedo(const LookSurfaces& surfaces);

}  // namespace rubble
