// A mesh as the passes want it: levels of detail cut into clusters that can be culled one by one,
// and the points at which its light is baked.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/math.h"
#include "render/geometry/light_nodes.h"
#include "render/scene/scene.h"

namespace rubble {

struct PreparedVertex {
  Vec3f position;  // in the mesh; unit: m
  Vec3f normal;    // unit length, mesh frame
};

struct PreparedTriangle {
  std::array<std::uint32_t, 3> vertices;  // into the vertices of the mesh
  std::uint32_t material;                 // index into the table of looks
  // Steps along its edges between nodes of light; 1: its vertices alone are nodes; range: 1 to 15.
  std::uint32_t light_steps = 1;
  std::uint32_t first_node = 0;  // of its grid, where it has one
};

// Of a triangle whose look is kPaintedAppearance.
struct TrianglePaint {
  std::array<PaintCorner, 3> corners;
  std::int32_t paint = -1;  // number in PreparedMesh::paints; of a mesh in a PreparedScene, in that scene's
  float red = 0;            // mean red albedo of its surface
};

// Neighbouring triangles that face about the same way.
struct Cluster {
  std::uint32_t first_triangle = 0, triangle_count = 0;  // of PreparedTriangle
  Vec3f centre;  // of a box and of a sphere around it, mesh frame; unit: m
  Vec3f half;    // of the box's sides
  float radius = 0;  // of that sphere; unit: m
  Vec3f cone_axis;         // mean normal
  float cone_cosine = -1;  // smallest cosine between a normal and the axis; -1: never culled
};

struct PreparedLevel {
  std::uint32_t first_cluster = 0, cluster_count = 0;    // of Cluster
  std::uint32_t first_triangle = 0, triangle_count = 0;  // of PreparedTriangle
};

struct PreparedMesh {
  std::vector<PreparedVertex> vertices;     // of all levels
  std::vector<PreparedTriangle> triangles;  // of all levels, by cluster
  std::vector<TrianglePaint> paint;         // one per triangle; empty where nothing is painted
  std::vector<std::shared_ptr<const SurfacePaint>> paints;
  std::vector<Cluster> clusters;            // of all levels, by level
  std::vector<PreparedLevel> levels;        // finest first
  std::vector<LightNode> light_nodes;       // where light is kept: the vertices, then grids of triangles
  std::vector<BakePoint> bake_points;       // where light is found
  std::vector<BakeOrigin> bake_origins;     // of all points
  Vec3f centre, half;                       // of a box around it; unit: m
  float radius = 0;                         // of a sphere about the same centre
  bool glass = false;                       // some triangle is of glass
};

// The side that a normal looks to: 0 and 1 are +x and -x, 2 and 3 y, 4 and 5 z.
int dominant_direction(const Vec3f& n);

// Throws RunError for a surface name that is no known look, naming it and the known ones.
PreparedMesh prepare_mesh(const SceneMesh& mesh, int threads = 1);

// The ground: z = 0, fine over the rectangle `around` (by its x and y) and ever coarser to 4 km.
PreparedMesh prepare_ground(const Aabb& around);

}  // namespace rubble
