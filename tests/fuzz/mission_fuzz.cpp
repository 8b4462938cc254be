#include "scripting/mission.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

// Small, so that a script that does not end ends soon.
static SandboxLimits limits() {
  SandboxLimits limits;
  limits.memory = std::size_t(16) << 20;
  limits.instructions = 200'000;
  limits.seconds = 5;
  return limits;
}

void fuzz_one(std::string_view bytes) {
  MissionOptions options;
  options.limits = limits();
  options.included.emplace();  // no files
  fuzz::knock([&] {
    const Mission mission = load_mission_text(std::string(bytes), "m.lua", options);
    scenario_from_json(scenario_to_json(mission.scenario), "again");  // what is accepted is written
  });
}
