// Heights on a grid as a closed mesh: terrain to stand on, with an inside.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/mesh.h"

namespace rubble {

// Heights at the corners of square cells. Each cell is two triangles, which meet on its diagonal from
// the lowest x and y to the highest; between the corners heights are those of the triangles.
struct HeightField {
  int columns = 0, rows = 0;  // corners along X and Y; range: 2 to 1024
  double spacing = 0.5;       // of neighbouring corners; unit: m; range: 0.01 to 100
  Vec3 origin;                // of the corner with the lowest x and y; z: where height is 0; unit: m
  // Row by row from the lowest y, each from the lowest x; columns * rows of them, finite. unit: m
  std::vector<double> heights;

  // Throws InputError naming the field, with `key` as the path of the height field.
  void validate(const char* key) const;
};

// A block with the heights as its upper side, walls around it and a level bottom `depth` below the
// lowest of them. All of it has the surface of the given name.
TriangleMesh make_height_field_mesh(const HeightField& field, double depth,
                                    const std::string& surface);

}  // namespace rubble
