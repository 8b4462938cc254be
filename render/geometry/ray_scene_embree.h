// What RayScene holds of Embree. Internal to its sources.
#pragma once

#include "render/geometry/embree_tree.h"
#include "render/geometry/ray_scene.h"

namespace rubble {

struct RayScene::Embree : EmbreeTree {};  // meshes by prepared mesh

// A placed mesh that moves: an instance in the tree.
struct RayScene::Mover {
  std::uint32_t placed = 0;          // which placed mesh
  std::uint32_t first_triangle = 0;  // in triangles_
  RTCGeometry geometry = nullptr;    // owned by the tree
};

}  // namespace rubble
