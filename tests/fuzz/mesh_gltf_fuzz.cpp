#include "io/mesh/mesh_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  static MeshImporter importer;
  const std::string path = fuzz::folder().write("a.gltf", bytes);
  fuzz::knock([&] { calc_volume_properties(importer.load_mesh(path)); });
}
