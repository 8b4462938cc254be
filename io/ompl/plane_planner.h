// Ways of a disc in the plane by OMPL's RRT* (Karaman and Frazzoli 2011, "Sampling-based algorithms for optimal motion
// planning"), over a map of how far places are from what is solid.
//
// Each plan has random numbers of its own, so that the same map, ends and seed give the same way whatever came before.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/geometry/voxel_grid.h"

namespace rubble {

// One layer of cells; Z is not looked at.
struct PlaneClearance {
  VoxelGrid grid;
  std::vector<float> clearance;  // from the middle of each cell to what is solid; unit: m
  double at(const Vec3& place) const;  // of the cell that a place is in; 0 outside of the grid
};

struct PlanePlannerOptions {
  double radius = 0.4;  // of the disc; unit: m; > 0
  // Within this of either end less clearance is enough, so that a disc that touches something can leave; unit: m
  double ends = 0.5;
  int samples = 800;    // of RRT*; > 0
  std::uint64_t seed = 0;
};

// Whether the disc has room on all of a straight leg between two places; the ends of the plan are not treated otherwise.
bool is_leg_free(const PlaneClearance& map, const Vec3& from, const Vec3& to, double radius);

// Corners from start to goal, both included; empty where no way was found. Throws InputError for options out of range and
// RunError when OMPL fails.
std::vector<Vec3> plan_in_plane(const PlaneClearance& map, const Vec3& from, const Vec3& to, const PlanePlannerOptions& options);

}  // namespace rubble
