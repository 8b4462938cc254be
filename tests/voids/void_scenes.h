// Piles of few placed solids whose voids are known in closed form.
#pragma once

#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/pile_state.h"

namespace rubble::testing {

struct VoidScene {
  PileState pile;
  std::vector<TriangleMesh> meshes;

  void add(TriangleMesh mesh, const Pose& pose = {});
  std::vector<const TriangleMesh*> pointers() const;
};

TriangleMesh make_box(const Vec3& low, const Vec3& high);
// Along X from 0 to length, about the axis y = z = 0; closed, with `sides` facets whose edges lie
// on the radii.
TriangleMesh make_pipe(double length, double inner, double outer, int sides = 256);
// Four walls and a roof of the given thickness around a room; the room's low corner at `low`.
// Each is a solid of its own; they overlap at the edges.
void add_room(VoidScene& scene, const Vec3& low, const Vec3& high, double thickness);

}  // namespace rubble::testing
