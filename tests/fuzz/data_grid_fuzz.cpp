#include "scripting/files/data_grid.h"
#include "tests/fuzz/fuzz_file.h"

#include <stdexcept>

using namespace rubble;

// Pictures of every kind that is read (PNG, JPEG, TIFF, WebP, BMP, PGM ...), and ESRI grids; what is kept is read again.
void fuzz_one(std::string_view bytes) {
  std::string kept;
  try {
    kept = data_grid_text(thinned(read_data_grid(bytes), 64));
  } catch (const std::runtime_error&) {
    return;
  }
  try {
    read_data_grid(kept, true);
  } catch (const std::runtime_error&) {
    std::abort();
  }
}
