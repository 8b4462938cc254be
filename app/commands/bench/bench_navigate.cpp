// `rubble bench navigate`: MRPT's reactive navigator drives a crawler through the voids of many piles (docs/explanation/autonomy.md).
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/navigate/navigation_bench.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"

namespace rubble {
namespace {

struct NavigateRequest {
  NavigationBenchRequest bench;
  bool json = false;   // --json
  bool force = false;  // --force
};

ExitCode navigate_all(const NavigateRequest& request) {
  stop_on_signals();
  NavigationBenchRequest asked = request.bench;
  if (asked.of.out.empty())
    asked.of.out = "out/" + std::filesystem::path(asked.of.mission).stem().string() + "_navigate";
  if (!asked.missions_only)
    refuse_to_replace(asked.of.out, {"missions.csv", "table.csv", "table.json"}, request.force);
  const bool quiet = asked.of.options.quiet;
  const std::vector<NavigationResult> results = run_navigation_bench(asked, [quiet](const std::string& line) {
    if (!quiet) print_err("%s\n", line.c_str());
  });
  if (results.empty())
    throw InputError({asked.of.mission, 0, "--seeds", "no pile of these seeds has a void for the crawler",
                      "other seeds, or a pile with larger voids", asked.seeds, ""});
  if (asked.missions_only) return ExitCode::done;
  write_score_file(asked.of.out + "/missions.csv", list_missions(results));
  for (const char* name : {"/table.csv", "/table.json"})
    write_score_file(asked.of.out + name, make_navigation_table(results, false));
  const std::vector<ScoreRow> table = make_navigation_table(results, true);
  print_result(request.json ? score_json(table) : score_text(table), request.json);
  return ExitCode::done;
}

Action declare_navigate(CommandLine& line) {
  const auto request = std::make_shared<NavigateRequest>();
  NavigationBenchRequest& bench = request->bench;
  add_mission_options(line, bench.of);
  line.add("--seeds", bench.seeds, "Seeds of the piles, as in 1..100 or 3,5,9").shows_default().metavar("SEEDS");
  line.add("--planner", bench.planner, "ompl: a global planner on the robot's own map; none: the navigator alone")
      .shows_default()
      .metavar("NAME");
  line.add_flag("--missions-only", bench.missions_only, "Write missions/SEED.lua for `rubble drive`; drive nothing");
  line.add("--out", bench.of.out, "Output folder").shows_default_text("out/<script>_navigate").metavar("DIR");
  line.add_flag("--force", request->force, "Replace the tables of an earlier call");
  line.add_flag("--json", request->json, "Print the table as JSON");
  add_threads_option(line, bench.of.options.threads);
  add_quiet_option(line, bench.of.options.quiet);
  return [request] { return navigate_all(*request); };
}

}  // namespace

Command bench_navigate_command() {
  return {"bench", "navigate", "Drive a crawler through the voids of many piles with the MRPT navigator", declare_navigate};
}

}  // namespace rubble
