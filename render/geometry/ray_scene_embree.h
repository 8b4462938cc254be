// What RayScene holds of Embree. Internal to its sources.
#pragma once

#include <embree3/rtcore.h>

#include <map>

#include "render/geometry/ray_scene.h"

namespace rubble {

inline constexpr unsigned kResting = 0;  // the geometry of all that rests: triangles, or their instance

struct RayScene::Embree {
  RTCDevice device = nullptr;                // owned
  RTCScene scene = nullptr;                  // of all pieces; owned
  // What rests, as an instance in `scene`, if anything moves: Embree builds all of a scene anew when anything in it has
  // changed. Owned.
  RTCScene resting = nullptr;
  std::map<std::uint32_t, RTCScene> meshes;  // of those that move, by prepared mesh

  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (resting) rtcReleaseScene(resting);
    for (const auto& [mesh, of_mesh] : meshes) rtcReleaseScene(of_mesh);
    if (device) rtcReleaseDevice(device);
  }

  RTCScene new_scene() const;
  void attach(RTCScene to, const std::vector<Vec3f>& positions,
              const std::vector<std::uint32_t>& indices) const;
  // Adds `of` to `scene` under that number, where it is. Owned by `scene`.
  RTCGeometry attach_instance(RTCScene of, unsigned number) const;
};

// A placed mesh that moves: an instance in the tree.
struct RayScene::Mover {
  std::uint32_t placed = 0;          // which placed mesh
  std::uint32_t first_triangle = 0;  // in triangles_
  RTCGeometry geometry = nullptr;    // owned by the tree
};

}  // namespace rubble
