// An imported scene as one mesh in metres with Z up.
#pragma once

#include <string>
#include <vector>

#include "io/import/imported_scene.h"
#include "kernel/base/mesh.h"

namespace rubble {

class MeshPaints;

// How the frame of a file becomes ours.
struct FileFrame {
  double metres_per_unit = 1;
  FileUp up = FileUp::z;
};

// Surfaces are the materials' names in order of first use. Vertices of equal position and normal are one. Triangles with
// two corners at one place are dropped; normals that are zero or no numbers become those of the faces, with a note.
// Throws InputError for a vertex that is no number, and where no triangle is left.
TriangleMesh join_meshes(ImportedScene& scene, const std::string& path, const FileFrame& frame, MeshPaints& paints);

// Closes the cracks of a mesh whose corners are equal but for rounding: corners closer than a millionth of its size
// (if that does not close it, a hundred-thousandth) move to one place. Returns whether it did; a mesh that is closed
// already, or that this does not close, stays as it is.
bool weld_cracks(TriangleMesh& mesh);

// The corner points of each object, in order of the file.
std::vector<std::vector<Vec3>> collect_parts(const ImportedScene& scene, const std::string& path, const FileFrame& frame);

}  // namespace rubble
