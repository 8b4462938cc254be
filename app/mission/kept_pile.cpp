#include "app/mission/kept_pile.h"

#include <algorithm>
#include <utility>

#include "app/provenance/compare.h"
#include "kernel/base/error.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/schema/override_text.h"

namespace rubble {
namespace {

constexpr std::size_t kNamed = 4;  // keys that the warning names

bool overlap(const std::string& a, const std::string& b) { return is_within(a, b) || is_within(b, a); }

// What each override sets, by its whole path, and what was written.
std::vector<std::pair<std::string, std::string>> list_set(const std::vector<std::string>& overrides) {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::vector<std::pair<std::string, std::string>> set;
  for (const std::string& text : overrides) set.emplace_back(override_path(schema, text), text);
  return set;
}

void refuse(const std::string& override_text, const Difference& difference, const std::string& run) {
  throw InputError({"", 0, "--set " + override_text, "changes nothing, because the pile of " + run + " is kept",
                    difference.path + " = " + difference.was, difference.is,
                    "settle another pile with it: `rubble settle MISSION --set " + override_text + " --out DIR`, and render that"});
}

}  // namespace

std::string describe_kept_pile(const Scenario& stated, const Scenario& kept, const std::vector<std::string>& overrides,
                               const std::string& run) {
  const std::vector<Difference> differences = list_differences(kept, stated), of_defaults = list_differences(Scenario{}, stated);
  const std::vector<std::pair<std::string, std::string>> set = list_set(overrides);
  std::vector<const Difference*> in_vain;
  for (const Difference& d : differences) {
    for (const auto& [path, text] : set) {
      if (overlap(path, d.path)) refuse(text, d, run);
    }
    const auto touches = [&d](const Difference& other) { return overlap(other.path, d.path); };
    if (std::any_of(of_defaults.begin(), of_defaults.end(), touches)) in_vain.push_back(&d);
  }
  if (in_vain.empty()) return "";
  std::string text = "the pile of the run is kept, not the one that the mission states: ";
  for (std::size_t i = 0; i < std::min(kNamed, in_vain.size()); ++i)
    text += (i > 0 ? ", " : "") + in_vain[i]->path + " is " + in_vain[i]->was + " instead of " + in_vain[i]->is;
  return in_vain.size() > kNamed ? text + ", and " + std::to_string(in_vain.size() - kNamed) + " more" : text;
}

}  // namespace rubble
