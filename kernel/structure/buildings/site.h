// The terrain under a building.
#pragma once

#include "kernel/base/mesh.h"
#include "kernel/structure/structure.h"

namespace rubble {

// A building stands on the ground z = 0. Throws InputError, with the place, where the terrain, whose mesh lies at
// `position` (m), reaches more than 1 mm into a member of the building or covers one.
void check_site(const Structure& building, const TriangleMesh& terrain, const Vec3& position);

}  // namespace rubble
