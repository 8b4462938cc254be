// Meshes from and to files.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

class IsolatedWorker;

// How the numbers of a file become metres with Z up.
struct MeshUnits {
  double metres_per_unit = 1;  // range: > 0; 0.001 for millimetres
  UpAxis up = UpAxis::z;       // of a file that does not state its own
  // Whether <up_axis> of a COLLADA file counts. Meshes of URDF files are taken as they are, as RViz takes them: many
  // programs write a statement that does not hold.
  bool heed_stated_axis = true;
};

// What of a file is not as the file says, a clause each.
struct MeshNotes {
  std::vector<std::string> shape;  // left out or repaired, whatever the mesh looks like: "lines beside its faces are left out"
  std::vector<std::string> looks;  // of its colours, which a look may replace: "the image wood.bmp is neither PNG nor JPEG"
};

// Reads many files by one child process: a child for each would cost 13 ms more a file.
class MeshImporter {
 public:
  MeshImporter();
  ~MeshImporter();

  // As the functions of these names.
  TriangleMesh load_mesh(const std::string& path, const MeshUnits& units = {});
  std::vector<std::vector<Vec3>> load_convex_parts(const std::string& path,
                                                   const MeshUnits& units = {});
  // Of the last mesh that was loaded.
  const MeshNotes& notes() const { return notes_; }

 private:
  std::string ask(char kind, const std::string& path, const MeshUnits& units);

  std::unique_ptr<IsolatedWorker> worker_;
  MeshNotes notes_;
};

// Reads OBJ, STL, PLY, glTF 2.0 and 3MF by readers of our own, and any other format by assimp (io/mesh_formats). Every mesh of the
// file is joined into one; surfaces are the materials' names, in order of first use, with paints where the file has
// colours (io/import/mesh_paint.h). Vertices of equal position and normal are welded, and cracks that are only rounding
// are closed. Throws InputError, naming the file and the reason, for one that is missing, unreadable or without
// triangles, or that needs what is not known; that crashes a reader, or makes it take too much time or
// memory (kernel/base/system/isolated_worker.h).
TriangleMesh load_mesh(const std::string& path, const MeshUnits& units = {});

// The convex parts of a shape: each object of the file is one, given by its corner points, in order
// of the file. Throws InputError as load_mesh, and for a part of less than 4 points.
std::vector<std::vector<Vec3>> load_convex_parts(const std::string& path,
                                                 const MeshUnits& units = {});

}  // namespace rubble
