#include "io/image/image_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("a.png", bytes);
  fuzz::knock([&] { read_rgb_png(path); });
}
