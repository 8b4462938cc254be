#include "scripting/suite_script.h"

#include <set>

#include "kernel/base/text.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"

namespace rubble {
namespace {

using MetricNames = std::vector<std::pair<std::string, std::string>>;

Schema make_suite_schema(std::vector<SuiteRun>& runs, const MetricNames& metrics) {
  Schema k;
  k.list("runs", runs, "One entry for each mission.").must();
  k.item("runs[].name", runs, &SuiteRun::name, "Of this entry, in reports.").must();
  k.item("runs[].mission", runs, &SuiteRun::mission, "Script, relative to the suite.").must();
  k.item("runs[].seeds", runs, &SuiteRun::seeds, "As 1..5 or 3,5,9; none: the mission's own.");
  k.item("runs[].set", runs, &SuiteRun::set, "Overrides, as in { \"pile.layers=2\" }.");
  k.item("runs[].pile_only", runs, &SuiteRun::pile_only, "Settle the pile, render nothing.");
  k.add("runs[].golden", "Hashes that must not change.", [&runs](std::size_t i) {
    return Schema::choice_slot(runs[i].golden, {"none", "pile", "all"});
  });
  k.group("runs[].expect", "Limits of metrics: { least, most }.");
  for (std::size_t m = 0; m < metrics.size(); ++m)
    k.add("runs[].expect." + metrics[m].first, metrics[m].second,
          [&runs, m, count = metrics.size()](std::size_t i) {
            runs[i].expect.resize(count);
            return Slot(&runs[i].expect[m]);
          });
  return k;
}

void check_names(const std::vector<SuiteRun>& runs, std::vector<Diagnostic>& mistakes) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string key = "runs[" + std::to_string(i + 1) + "].name";
    const std::string& name = runs[i].name;
    const std::string fault = name.empty() ? "" : find_name_fault(name);
    if (!fault.empty())
      mistakes.push_back({"", 0, key, "the name " + fault, kNameRule, "\"" + name + "\"", "it is the name of a folder"});
    if (!name.empty() && !names.insert(name).second)
      mistakes.push_back({"", 0, key, "two runs have the name `" + name + "`", "", "", ""});
  }
}

// With seeds the mission's own has no effect, wherever it comes from.
void check_seeds(const std::vector<SuiteRun>& runs, std::vector<Diagnostic>& mistakes) {
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const std::string& text : runs[i].set)
      if (!runs[i].seeds.empty() && text.rfind("seed=", 0) == 0)
        mistakes.push_back({"", 0, "runs[" + std::to_string(i + 1) + "].set", "`seeds` gives the seeds of this entry",
                            "a key besides the seed", "\"" + text + "\"", "leave one of both out"});
}

}  // namespace

SuiteScript load_suite(const std::string& path, const MetricNames& metrics) {
  const SourceFile script = read_script(path);
  const SourceMap lines(script.text, "suite");
  LuaSandbox sandbox(0, "suite");
  const Value table = run_script(sandbox, script, lines);
  if (table.kind != Value::Kind::table)
    throw InputError({path, lines.line_of(""), "", "the script does not return a suite",
                      "return suite { ... }", describe(table), ""});
  SuiteScript suite{path, {}};
  std::vector<Diagnostic> mistakes;
  read_table(make_suite_schema(suite.runs, metrics), table, mistakes);
  add_duplicates(lines, mistakes);
  check_names(suite.runs, mistakes);
  check_seeds(suite.runs, mistakes);
  if (mistakes.empty() && suite.runs.empty())
    mistakes.push_back({"", 0, "runs", "no runs", "at least one", "an empty list", ""});
  locate(mistakes, path, lines);
  throw_if_any(std::move(mistakes));
  for (SuiteRun& run : suite.runs) run.expect.resize(metrics.size());
  return suite;
}

}  // namespace rubble
