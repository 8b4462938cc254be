#include "io/state/fines_file.h"
#include "kernel/geometry/fine_shapes.h"
#include "tests/fuzz/fuzz_file.h"
#include "tests/fuzz/sealed_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path =
      fuzz::folder().write("fines.bin", fuzz::seal("RUBFINE\n", kFinesVersion, bytes));
  fuzz::knock([&] {
    Fines fines = load_fines(path, 5);
    heap_fines(fines);
  });
}
