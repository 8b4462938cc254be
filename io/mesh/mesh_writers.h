// A settled pile as one mesh file for other programs. Metres and right-handed everywhere; Z up
// but for glTF, which wants Y up: (x, y, z) becomes (x, z, -y).
//
//   ply   binary; distinct positions, each with its piece's number and a colour
//   obj   and .mtl beside it; one object per piece, distinct positions without normals, materials
//   glb   glTF 2.0; one mesh per asset, one node per piece with its pose and scale, materials
#pragma once

#include <string>

#include "io/mesh/pile_model.h"

namespace rubble {

// Each throws RunError when the file cannot be written.
void write_ply(const std::string& path, const PileModel& model);
void write_obj(const std::string& path, const PileModel& model);  // and .mtl for .obj
void write_glb(const std::string& path, const PileModel& model);

}  // namespace rubble
