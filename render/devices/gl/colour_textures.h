// What GlColourPass looks up that does not change while it draws: images on the card, with filtering. All throw RunError where
// the card has no room.
#pragma once

#include <vector>

#include "render/geometry/ground_map.h"
#include "render/gl/gl_objects.h"
#include "render/lighting/sky.h"
#include "render/materials/textures.h"

namespace rubble {

// A layer for each surface, with mipmaps. patterns: of one size, at least one.
GlTexture upload_surface_appearances(const Gl& gl, const std::vector<PatternImage>& patterns);
GlTexture upload_sky(const Gl& gl, const Sky& sky);
GlTexture upload_ground(const Gl& gl, const GroundMap& ground);

}  // namespace rubble
