// Contacts of one convex part with a fixed surface. The triangles near it are no bodies of their own:
// points on all of them are gathered and put together by their normals, so that a piece lies on many
// level triangles as on one plane, and no edge between two triangles catches it.
#pragma once

#include <vector>

#include "kernel/collision/narrow_phase.h"
#include "kernel/geometry/triangle_mesh_shape.h"

namespace rubble {

struct PosedSurface {
  const TriangleMeshShape* surface = nullptr;  // at scale 1; must outlive this
  Mat3 rotation;                               // world from surface
  Vec3 position;                               // unit: m
  double scale = 1;                            // of the surface's lengths; above 0

  PosedSurface(const Body& body);
  // The box around a box of the world, in the frame of the surface at scale 1.
  Aabb to_local(const Aabb& world_box) const;
};

// Finds the contacts anew. `a`: the part, with the box around it in the world. `slots`: those of the
// step before, which keep their place while their normal stays; without points: nothing there.
// A part has at most kSurfaceSlots contacts with a surface, each with a normal of its own.
void update_surface_contacts(Contact* const (&slots)[kSurfaceSlots], const PosedBody& a,
                             const Aabb& box, const PosedSurface& b, float margin,
                             const NarrowSettings& settings);

}  // namespace rubble
