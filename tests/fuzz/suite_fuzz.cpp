#include "scripting/suite_script.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("suite.lua", bytes);
  fuzz::knock([&] { load_suite(path, {{"pieces", "How many."}, {"frames", "How many."}}); });
}
