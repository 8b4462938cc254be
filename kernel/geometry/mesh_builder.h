// Puts meshes together from quads, boxes and tubes: of surroundings and of what robots look like.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/mesh.h"

namespace rubble {

class MeshBuilder {
 public:
  // What is added from now on has this look.
  void look(const std::string& name);

  // Counter-clockwise seen from outside.
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
  // Both sides of a thin sheet.
  void leaf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
  // Two opposite corners; from low to high.
  void box(const Vec3& low, const Vec3& high);
  // A round bar from a to b, closed at both ends. sides: 3 and up.
  void tube(const Vec3& a, const Vec3& b, double radius_a, double radius_b, int sides);
  // A fan of triangles over the corners of a convex face.
  void face(const std::vector<Vec3>& corners);

  // All that is added lies in this frame from now on.
  void frame(const Pose& world_from_part) { frame_ = world_from_part; }

  bool empty() const { return mesh_.triangles.empty(); }
  // With one normal a flat face.
  TriangleMesh take();
  // With normals that are smooth across edges flatter than `crease_deg` within one look.
  TriangleMesh take_smooth(double crease_deg);

 private:
  TriangleMesh mesh_;
  std::uint8_t look_ = 0;
  Pose frame_;
};

}  // namespace rubble
