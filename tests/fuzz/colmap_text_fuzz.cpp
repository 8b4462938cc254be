#include "io/datasets/colmap_model.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

// The three files of a model, apart by a line of dashes.
static void write_model(std::string_view bytes, const char* extension) {
  for (const char* name : {"cameras", "images", "points3D"}) {
    const std::size_t end = std::min(bytes.find("-----"), bytes.size());
    fuzz::folder().write(std::string(name) + extension, bytes.substr(0, end));
    bytes.remove_prefix(std::min(end + 5, bytes.size()));
  }
}

void fuzz_one(std::string_view bytes) {
  write_model(bytes, ".txt");
  fuzz::knock([&] { load_colmap_model(fuzz::folder().path()); });
}
