#include "scripting/files/calibration.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  fuzz::knock([&] { parse_calibration(bytes, "c"); });
}
