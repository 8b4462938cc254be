#include "io/mesh_formats/gltf_document.h"
#include "tests/fuzz/fuzz_mesh.h"

// Files of glTF 1.0 go to assimp, which is not looked at here.
void fuzz_one(std::string_view bytes) {
  const std::string version = rubble::GltfDocument::version_of(rubble::fuzz::folder().write("a.glb", bytes));
  if (version.empty() || version[0] != '1') rubble::fuzz::read_mesh("a.glb", bytes);
}
