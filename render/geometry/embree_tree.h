// A tree of Embree for triangles that rest and meshes that move, and all that it owns. Internal to what casts rays.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/system/embree.h"

namespace rubble {

struct EmbreeTree {
  static constexpr unsigned kResting = 0;  // the geometry of all that rests: triangles, or their instance; movers follow

  // One thread builds: the tree, and with it the choice among equal hits, is then always the same. Throws RunError where
  // Embree gives no device.
  EmbreeTree();
  ~EmbreeTree();
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  RTCScene new_scene() const;  // owned by who asks
  // indices: three a triangle. Throws RunError where memory is short.
  void attach(RTCScene to, const std::vector<Vec3f>& positions, const std::uint32_t* indices, std::size_t triangles) const;
  // Adds `of` to `scene` under that number; neither placed nor committed. Owned by `scene`.
  RTCGeometry attach_instance(RTCScene of, unsigned number) const;
  // Throws RunError where Embree reports an error.
  void commit();

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;  // of all
  // What rests, as an instance in `scene`, if anything moves: Embree builds all of a scene anew when anything in it has
  // changed.
  RTCScene resting = nullptr;
  std::map<std::uint32_t, RTCScene> meshes;  // of those that move, by their numbers
};

}  // namespace rubble
