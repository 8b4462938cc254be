#include "app/provenance/provenance.h"
#include "app/support/json_members.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  fuzz::knock([&] {
    const auto json = parse_json_text(std::string(bytes), "run.json");
    const Provenance provenance = provenance_from_json(json, "run.json");
    stated_scenario(provenance);
  });
}
