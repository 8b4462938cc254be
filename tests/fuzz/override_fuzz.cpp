#include "kernel/base/error.h"
#include "scripting/scenario/mission_form.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

// As load_mission_text does with each --set, without a script before it.
void fuzz_one(std::string_view bytes) {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::vector<Diagnostic> mistakes;
  apply_override(schema, std::string(bytes), mistakes);
  if (mistakes.empty() && find_mistakes(form).empty())
    fuzz::knock([&] { scenario_from_json(scenario_to_json(form.normalized()), "again"); });
}
