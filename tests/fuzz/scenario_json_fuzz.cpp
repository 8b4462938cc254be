#include "scripting/mission.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  fuzz::knock([&] { scenario_from_json(std::string(bytes), "manifest.json"); });
}
