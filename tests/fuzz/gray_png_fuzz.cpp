#include "scripting/sandbox/gray_image.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  try {
    parse_pgm(png_to_pgm(std::string(bytes)));
  } catch (const std::runtime_error&) {
  }
}
