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
  UpAxis up = UpAxis::z;       // of the file
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
  // What of the colours of the last mesh that was loaded cannot be drawn, a clause each: "the image
  // wood.bmp is neither PNG nor JPEG".
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::string ask(char kind, const std::string& path, const MeshUnits& units);

  std::unique_ptr<IsolatedWorker> worker_;
  std::vector<std::string> notes_;
};

// Reads any format that assimp knows. Every mesh of the file is joined into one; surfaces are the
// materials' names, in order of first use, with paints where the file has colours (io/mesh/mesh_paint.h).
// Vertices of equal position and normal are welded.
// Throws InputError, naming the file and the reason, for one that is missing, unreadable, without
// triangles, or that holds points or lines; that crashes assimp, or makes it take too much time or
// memory (kernel/base/system/isolated_worker.h).
TriangleMesh load_mesh(const std::string& path, const MeshUnits& units = {});

// The convex parts of a shape: each object of the file is one, given by its corner points, in order
// of the file. Throws InputError as load_mesh, and for a part of less than 4 points.
std::vector<std::vector<Vec3>> load_convex_parts(const std::string& path,
                                                 const MeshUnits& units = {});

}  // namespace rubble
