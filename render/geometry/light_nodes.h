// Where light is kept on a mesh, and where it is found.
//
// Light is kept at nodes: the vertices of the mesh, and on triangles with long edges a grid of further
// ones, in barycentric steps ("mesh colours", Yuksel et al. 2010), so that light varies along a face
// without one triangle more to draw. It is found at bake points, fewer than there are nodes where the
// mesh is fine; each node takes the light of up to four points about it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct PreparedMesh;

struct LightNode {
  Vec3f position, normal;      // mesh frame
  std::uint32_t triangle = 0;  // one that it lies on
  float u = 0, v = 0;          // there: weights of its second and third corner
  std::array<std::uint32_t, 4> points{};  // bake points
  std::array<float, 4> weights{};         // add up to 1
};

// Light is found by rays from the origins of a point: places all over the surface that it stands for.
struct BakeOrigin {
  Vec3f position, normal;  // mesh frame
};

struct BakePoint {
  Vec3f position, normal;  // mesh frame
  std::uint32_t first_origin = 0, origin_count = 0;
};

// Grid of a triangle whose edges are cut into n steps: node (i, j) has weights i / n of the second
// corner and j / n of the third.
inline constexpr std::uint32_t kMostLightSteps = 15;
inline std::uint32_t light_node_count(std::uint32_t n) { return (n + 1) * (n + 2) / 2; }
inline std::uint32_t light_node_index(std::uint32_t n, std::uint32_t i, std::uint32_t j) {
  return j * (2 * n + 3 - j) / 2 + i;
}

// The three nodes about a place on a triangle, and their weights; as in shaders/geometry.glsl.
struct LightNodes {
  std::array<std::uint32_t, 3> node;
  std::array<float, 3> weight;
};
LightNodes find_light_nodes(const PreparedMesh& mesh, std::uint32_t triangle, float u, float v);

// Makes the nodes and points of a mesh that has its vertices and triangles. Points are chosen on the first
// `finest_triangles` triangles. spacing: between nodes along a long edge; cell: of space, one point each; 0: by the
// mesh's size; unit: m.
void make_light_nodes(PreparedMesh& mesh, std::size_t finest_triangles, float spacing, float cell = 0, int threads = 1);

// The same for a level ground, whose nodes near the middle are points themselves: triangles with an edge
// longer than `longest` get no further nodes. unit: m.
void make_ground_nodes(PreparedMesh& mesh, float spacing, float longest);

}  // namespace rubble
