// Where air changes the light of the place: the box of the pieces and a little around them. The sun and the sky of a
// mission are what arrives at this box; farther away, air only veils what a camera sees.
#pragma once

#include "kernel/base/math.h"

namespace rubble {

// bounds: of all pieces.
Aabb air_box(const Aabb& bounds);
bool in_box(const Aabb& box, const Vec3& p);
// The part between two distances of a ray that lies in the box; false: none.
bool clip_to_box(const Aabb& box, const Vec3f& from, const Vec3f& direction, float& near, float& far);

}  // namespace rubble
