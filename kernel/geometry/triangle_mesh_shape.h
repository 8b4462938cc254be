// A fixed surface of triangles, such as terrain, compiled for collision: who neighbours whom, and a
// tree of boxes, so that what is far away costs nothing.
//
// Corners of the mesh that lie in one place are one corner here. Coordinates in metres, in the frame
// of the type at scale 1.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

class TriangleMeshShape {
 public:
  // How a triangle goes on beyond an edge.
  enum class EdgeConvexity : std::uint8_t {
    flat,     // level with it: the edge is none to what lies on both
    concave,  // upwards, towards the side that it faces
    convex,   // downwards; also where nothing follows
  };
  struct Triangle {
    std::uint32_t corners[3] = {};   // counter-clockwise seen from the side that is free
    std::int32_t beyond[3] = {};     // the corner across the edge from k to k + 1; -1: none
    EdgeConvexity folds[3] = {};     // of the same edges
    bool sharp = false;              // a convex edge ends at one of its corners, or is its own
    Vec3 normal;                     // unit length
  };

  // Throws std::invalid_argument for a triangle without its corners, or when none has an area.
  explicit TriangleMeshShape(const TriangleMesh& mesh);

  const std::vector<Vec3>& corners() const { return corners_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  Aabb bounds() const { return nodes_[0].box; }

  // The triangles whose boxes meet `box`, ascending.
  void find(const Aabb& box, std::vector<std::int32_t>& found) const;
  bool meets(const Aabb& box) const;

  // Whether a plane with this normal (unit length) through the corners of a triangle that lie
  // farthest along it leaves all around them behind it. Otherwise nothing can touch them along it:
  // the neighbours are in the way.
  bool is_exposed(const Triangle& triangle, const Vec3& normal) const;

 private:
  struct Node {
    Aabb box;
    std::int32_t first = 0, count = 0;  // of order_, in a leaf
    std::int32_t right = 0;             // the other child; the one child follows; 0: a leaf
  };
  void weld(const TriangleMesh& mesh);
  void join();
  void mark_sharp();
  int build(int first, int count);
  Aabb box_of(const Triangle& triangle) const;

  std::vector<Vec3> corners_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> around_;  // by corner: those that an edge leads to
  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

}  // namespace rubble
