#include "scripting/mission.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  MissionOptions options;
  options.overrides.push_back(std::string(bytes));
  options.included.emplace();
  fuzz::knock([&] {
    load_mission_text("return { pile = { mix = { { asset = 'a' } } } }", "m.lua", options);
  });
}
