// `rubble bench search`: who finds the people in the voids of many piles (docs/explanation/search.md).
#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/search/search_bench.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"

namespace rubble {
namespace {

struct Request {
  SearchBenchRequest search;
  bool json = false;   // --json
  bool force = false;  // --force
};

ExitCode search(const Request& request) {
  stop_on_signals();
  SearchBenchRequest asked = request.search;
  if (asked.of.out.empty())
    asked.of.out = "out/" + std::filesystem::path(asked.of.mission).stem().string() + "_search";
  refuse_to_replace(asked.of.out, {"searches.csv", "table.csv", "table.json"}, request.force);
  const bool quiet = asked.of.options.quiet;
  const std::vector<SearchResult> results = run_search_bench(asked, [quiet](const std::string& line) {
    if (!quiet) print_err("%s\n", line.c_str());
  });
  if (results.empty())
    throw InputError({asked.of.mission, 0, "--seeds", "no pile of these seeds has room for the victims",
                      "other seeds, or a pile with larger voids", asked.seeds, ""});
  write_score_file(asked.of.out + "/searches.csv", list_searches(results));
  const std::vector<ScoreRow> table = make_search_table(results);
  for (const char* name : {"/table.csv", "/table.json"}) write_score_file(asked.of.out + name, table);
  print_result(request.json ? score_json(table) : score_text(table), request.json);
  const auto failed = std::find_if(results.begin(), results.end(),
                                   [](const SearchResult& r) { return !r.score.failure.empty(); });
  if (failed == results.end()) return ExitCode::done;
  print_err("the agent failed, first with seed %llu: %s\n", static_cast<unsigned long long>(failed->seed),
            failed->score.failure.c_str());
  return ExitCode::failure;
}

Action declare(CommandLine& line) {
  const auto request = std::make_shared<Request>();
  SearchBenchRequest& search_request = request->search;
  add_mission_options(line, search_request.of);
  const Option agent = line.add("--agent", search_request.agent, "Program of an agent; it reads and writes lines of JSON")
                           .metavar("COMMAND");
  line.add("--baseline", search_request.baselines, "Baseline agent: random, wall, frontier, octomap or oracle; may "
                                                   "be repeated")
      .metavar("NAME");
  line.add("--seeds", search_request.seeds, "Seeds of the piles, as in 1..100 or 3,5,9").shows_default().metavar("SEEDS");
  line.add("--deadline", search_request.deadline, "Time limit for an answer of the agent; three times longer for the "
                                                  "first answer")
      .shows_default("s")
      .metavar("SECONDS")
      .within(0.01, 3600.0)
      .needs(agent);
  line.add("--out", search_request.of.out, "Output folder")
      .shows_default_text("out/<script>_search")
      .metavar("DIR");
  line.add_flag("--force", request->force, "Replace the tables of an earlier call");
  line.add_flag("--json", request->json, "Print the table as JSON");
  add_threads_option(line, search_request.of.options.threads);
  add_quiet_option(line, search_request.of.options.quiet);
  return [request] { return search(*request); };
}

}  // namespace

Command bench_search_command() {
  return {"bench", "search", "Compare agents that search for victims in the voids of many piles", declare};
}

}  // namespace rubble
