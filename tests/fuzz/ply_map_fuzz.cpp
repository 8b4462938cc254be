#include "io/mesh_formats/ply_reader.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("map.ply", bytes);
  fuzz::knock([&] { load_ply(path); });
}
