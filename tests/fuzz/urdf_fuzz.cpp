#include "io/robot/urdf_reader.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("a.urdf", bytes);
  fuzz::knock([&] { read_urdf(path); });
}
