#include "io/image/exr_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("a.exr", bytes);
  fuzz::knock([&] { read_exr(path, {"Z"}); });
}
