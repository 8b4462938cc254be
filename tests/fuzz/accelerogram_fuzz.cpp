#include "scripting/files/accelerogram.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  accelerogram_head_lines(bytes);
  fuzz::knock([&] { parse_accelerogram(bytes, "a"); });
  fuzz::knock([&] { parse_accelerogram(bytes, "a", {0.01, "g"}); });
}
