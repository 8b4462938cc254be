// A void map as OpenVDB grids, for Houdini, Blender and every program that reads .vdb.
#pragma once

#include <string>

#include "kernel/voids/void_map.h"

namespace rubble {

// World frame, metres; values at the centres of voxels; voxels outside of the pile are not stored.
//   clearance        float, fog volume: distance to the nearest surface in voids; unit: m
//   widest_path      float: radius of the largest ball that can come there from outside; unit: m
//   solid            bool
//   voids_r<radius>  int32, one per robot radius: 1 and up, the void's rank; radius in mm
// The same bytes for the same map: the file's UUID is made from its content. Throws RunError.
void write_vdb(const std::string& path, const VoidMap& map);

}  // namespace rubble
