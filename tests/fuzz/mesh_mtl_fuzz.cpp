#include <cstdlib>

#include "tests/fuzz/fuzz_mesh.h"

using namespace rubble;

// A material library: whatever it says, the mesh is read.
void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write(
      "m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
  fuzz::folder().write("m.mtl", bytes);
  ImportedScene scene = read_scene(path);
  MeshPaints paints(scene, path);
  if (join_meshes(scene, path, {}, paints).triangles.size() != 1) std::abort();
}
