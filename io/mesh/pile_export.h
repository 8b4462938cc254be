// A settled pile as a mesh or a world for other programs. Metres and right-handed everywhere; Z up
// but for glTF, which wants Y up: (x, y, z) becomes (x, z, -y).
//
//   stl   binary; triangles alone
//   ply   binary; distinct positions, each with its piece's number and a colour
//   obj   and .mtl beside it; one object per piece, distinct positions, normals, materials
//   glb   glTF 2.0; one mesh per asset, one node per piece with its pose and scale, materials
//   sdf   a folder: pile.sdf, an SDF 1.9 world of static models, and meshes/ASSET.obj
#pragma once

#include <string>
#include <vector>

#include "io/mesh/pile_model.h"

namespace rubble {

// Each throws RunError when the file cannot be written.
void write_ply(const std::string& path, const PileModel& model);
void write_obj(const std::string& path, const PileModel& model);  // and .mtl for .obj
void write_glb(const std::string& path, const PileModel& model);
void write_sdf(const std::string& folder, const PileModel& model);

// What export_pile knows: "stl", "ply", "obj", "glb", "sdf".
std::vector<std::string> export_formats();

// Writes FOLDER/pile.stl, and so on. Returns the names of what was written, relative to the folder.
// Throws InputError for an unknown format, RunError when it cannot be written.
std::vector<std::string> export_pile(const PileModel& model, const std::string& format,
                                     const std::string& folder);

}  // namespace rubble
