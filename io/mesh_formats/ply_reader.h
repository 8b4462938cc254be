// Point clouds and meshes that others wrote as PLY.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/import/imported_scene.h"
#include "kernel/base/math.h"

namespace rubble {

struct PlyMesh {
  std::vector<Vec3> positions;                          // in the file's own unit and frame
  std::vector<std::array<std::uint32_t, 3>> triangles;  // of polygons and strips; empty: a point cloud
  std::vector<Vec3f> normals;                           // as written; empty, or one per position
  std::vector<Vec3f> colours;                           // sRGB, 0 to 1; empty, or one per position
  std::vector<std::array<float, 2>> places;             // in the image, v upwards; empty, or one per position
  std::uint64_t short_faces = 0;                        // of less than three corners; they are left out
  std::string image;                                    // of a comment TextureFile; empty: none
  std::vector<std::string> notes;                       // what is not read, a clause each
};

// Reads ascii and binary PLY of both byte orders: of the element `vertex` places, normals, colours and texture
// coordinates; of `face` and `tristrips` the list vertex_indices (or vertex_index). Other properties and elements are
// passed over. Throws InputError with file and line (header, ascii) or byte (binary) for: another format, a vertex
// without x, y or z, a place that is not finite, a corner that is not there or whose number is not whole, a file that ends
// early, no vertex at all.
PlyMesh load_ply(const std::string& path);

// The same as a mesh. Throws InputError for a point cloud.
ImportedScene read_ply_scene(const std::string& path);

}  // namespace rubble
