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
// Whether write_sdf() may have written it. name: relative to its folder.
bool is_sdf_file(const std::string& name);

// What a format's size depends on. A mesh counts once for each piece that has it in `triangles`,
// and once at all in `type_triangles`.
struct PileModelSize {
  double pieces = 0, triangles = 0;      // counts
  double types = 0, type_triangles = 0;  // counts
};

// A format, complete: what writes it, what it leaves, and how large that gets at most.
struct MeshFormat {
  std::string name;                                                // "obj": of --format and outputs.meshes
  std::vector<std::string> leaves;                                 // files in the output folder, or one folder
  bool is_folder = false;                                          // true: `leaves` is one folder
  void (*write)(const std::string& path, const PileModel& model);  // path: of the last of `leaves`
  double (*estimate)(const PileModelSize& size);                   // unit: byte
};

// Every format. docs/development/contributing.md says how to add one.
const std::vector<MeshFormat>& mesh_formats();

// Their names joined by commas and a last word: "stl, ply, obj, glb or sdf".
std::string join_mesh_formats(const std::string& last_word);

// Throws InputError for a name that is no format's.
const MeshFormat& find_mesh_format(const std::string& name);

// Writes FOLDER/pile.stl, and so on. Returns the names of what was written, relative to the folder.
// Throws InputError for an unknown format, RunError when it cannot be written.
std::vector<std::string> export_pile(const PileModel& model, const std::string& format,
                                     const std::string& folder);

}  // namespace rubble
