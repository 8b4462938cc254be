// The working mesh of the generator: welded, closed, one surface per triangle.
#pragma once

#include <array>
#include <vector>

#include "assets/generator/solid.h"
#include "kernel/base/mesh.h"

namespace rubble::generator {

struct SurfaceMesh {
  std::vector<Vec3> positions;                // unit: m
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<Surface> surfaces;              // one per triangle
};

// The zero surface of a solid by marching tetrahedra, which is closed and manifold whatever the
// field. cell: edge of the sampling grid; unit: m
SurfaceMesh mesh_solid(const Solid& solid, double cell);

struct DecimateOptions {
  int triangles = 1000;    // stop at this many
  double max_edge = 0.15;  // collapse nothing into an edge longer than this; unit: m
  // The least cosine between a triangle's normals before and after a collapse. Where folded sheet
  // lets too little go at the usual one, coarse levels take a smaller.
  double facing = 0.25;
};

// Fewer triangles by edge collapses in order of the quadric error (Garland and Heckbert 1997).
// Closed stays closed; borders between surfaces keep their line.
SurfaceMesh decimate(const SurfaceMesh& mesh, const DecimateOptions& options);

void append(SurfaceMesh& mesh, const SurfaceMesh& more);

// To 10 um, the resolution of the files.
Vec3 rounded_for_file(const Vec3& p);

// Rounds the positions as written to files, and gives every corner a normal: smooth
// across edges flatter than `crease_deg` within one surface, split at others.
TriangleMesh finish(const SurfaceMesh& mesh, double crease_deg);
inline constexpr double kCreaseDeg = 42;  // of solids

}  // namespace rubble::generator
