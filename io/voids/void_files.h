// Files of void maps: JSON, pictures, meshes of surfaces, OpenVDB and OctoMap.
#pragma once

#include <cstdint>
#include <string>

#include "io/image/image_file.h"
#include "kernel/base/mesh.h"
#include "kernel/voids/void_map.h"
#include "kernel/voids/void_space.h"

namespace rubble {

// voids.json: the voids of a pile, their entrances, and the graph of chambers and throats.
// Indented JSON, ending in a line feed; lengths in metres, volumes in m3, world frame; stable keys,
// described in docs/explanation/voids.md. Numbers are rounded to 0.1 mm (positions, radii) or 1e-6 m3.
std::string make_void_json(const VoidMap& map);

// Pictures of a void map: seen from above, and cut open.
struct VoidPictureOptions {
  int long_side = 1400;  // of the drawing, without title and legend; unit: pixel; 200 to 8000
  double margin = 1.0;   // shown around the robot's voids; unit: m
  int labels = 12;       // voids whose entrances bear their rank; others have small arrows
  std::string title;     // ASCII
};

// From above, north (Y) up: the pile in grey by height, the voids of one robot coloured by how much
// free height is below each point, entrances as arrows with the rank of the void in voids.json.
// Only the part around the voids is shown.
// robot: index into map.robots.
RgbImage draw_void_plan(const VoidMap& map, std::size_t robot,
                        const VoidPictureOptions& options = {});

// A vertical cut through a point across the given axis (0: the plane of Y and Z, 1: of X and Z):
// solid dark, outside pale, void coloured by clearance, what the robot covers outlined, with
// entrances within 0.3 m of the cut as arrows.
RgbImage draw_void_cut(const VoidMap& map, std::size_t robot, int axis, const Vec3& through,
                       const VoidPictureOptions& options = {});

// The surface of a void as a mesh.

// Around the cells that the robot covers, smoothed over about a voxel; closed, outward, welded.
TriangleMesh make_void_surface(const VoidSpace& space, const Void& v);

// Binary little-endian PLY: positions (float, metres, world frame) and triangles, with the pile's state hash as a
// comment. Throws RunError.
void write_void_surface(const std::string& path, const TriangleMesh& mesh, std::uint64_t pile_state);

// Whether such a file says that it is of this pile. Throws InputError when it cannot be read.
bool is_void_surface_of(const std::string& path, std::uint64_t pile_state);

// A void map as OpenVDB grids, for Houdini, Blender and every program that reads .vdb.
// World frame, metres; values at the centres of voxels; voxels outside of the pile are not stored.
//   clearance        float, fog volume: distance to the nearest surface in voids; unit: m
//   widest_path      float: radius of the largest ball that can come there from outside; unit: m
//   solid            bool
//   voids_r<radius>  int32, one per robot radius: 1 and up, the void's rank; radius in mm
// The same bytes for the same map: the file's UUID is made from its content. Throws RunError.
void write_vdb(const std::string& path, const VoidMap& map);

// A void map as an OctoMap: solid is occupied, void is free, everything else is unknown.
// Binary .bt with the grid's voxel as resolution. OctoMap's leaves lie on multiples of the
// resolution, as do the voxels. Throws RunError.
void write_octomap(const std::string& path, const VoidSpace& space);

}  // namespace rubble
