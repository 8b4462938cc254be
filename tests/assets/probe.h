// Distances between a mesh and its collision parts, both ways.
#pragma once

#include <vector>

#include "tests/assets/obj_reader.h"

namespace rubble::test {

struct HalfSpace {
  Vec3 normal;
  double offset;
};

// The planes of a part's triangles.
std::vector<HalfSpace> planes_of(const Part& part);

// How far a point is outside a convex part; negative inside. A lower bound near corners. unit: m
double height_above(const std::vector<HalfSpace>& part, const Vec3& p);

// unit: m
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
double distance_to_mesh(const Vec3& p, const TriangleMesh& mesh);

// Points over the hull's triangles, about `spacing` apart, that lie in no other part.
std::vector<Vec3> exposed_points(const std::vector<Part>& parts, double spacing);

// Share of the parts' bounding box that lies in any of them, times its volume; error about 1 %.
double calc_union_volume(const std::vector<Part>& parts);

}  // namespace rubble::test
