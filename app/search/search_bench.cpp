#include "app/search/search_bench.h"

#include <algorithm>
#include <cstdio>

#include "app/batch/seed_list.h"
#include "app/eval/scores/confidence.h"
#include "app/pipeline/seeded_piles.h"
#include "app/search/program_agent.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

constexpr const char* kAgent = "agent";  // the row of the user's program

std::vector<std::string> names_of(const SearchBenchRequest& request) {
  std::vector<std::string> names;
  if (!request.agent.empty()) names.push_back(kAgent);
  const std::vector<std::string> known = baseline_names();
  for (const std::string& name : request.baselines) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw unknown_baseline(name);
    names.push_back(name);
  }
  if (names.empty())
    throw InputError({"", 0, "--agent", "no agent is given", "--agent COMMAND or --baseline NAME", "neither", ""});
  return names;
}

std::string text_of(std::uint64_t seed, const std::string& name, const SearchScore& score) {
  char text[200];
  std::snprintf(text, sizeof text, "seed %llu, %s: %d of %d found in %.0f s, %d false reports, %.0f %% of the voids seen",
                static_cast<unsigned long long>(seed), name.c_str(), score.found, score.victims, score.time,
                score.false_reports, 100 * score.coverage);
  return text + (score.failure.empty() ? "" : "; " + score.failure);
}

std::unique_ptr<SearchAgent> make_agent(const SearchBenchRequest& request, const std::string& name,
                                        const SearchWorld& world, std::uint64_t seed) {
  const SearchBriefing briefing = make_briefing(world, seed);
  if (name != kAgent) return make_baseline(name, briefing, world);
  return start_program_agent(
      {request.agent, request.of.out + "/agent_" + std::to_string(seed) + ".log", request.deadline}, briefing);
}

void expect_victims(const ResolvedMission& mission, const std::string& script) {
  if (mission.scenario.victims.count == 0)
    throw InputError({script, 0, "victims.count", "there are no victims", "1 or more", "0",
                      "victims = { count = 4 } in the mission, or --set victims.count=4"});
}

}  // namespace

std::vector<SearchResult> run_search_bench(const SearchBenchRequest& request,
                                           const std::function<void(const std::string&)>& note) {
  const std::vector<std::string> names = names_of(request);
  const SeededPiles piles{request.of, parse_seeds(request.seeds, "--seeds"), {"victims.count", "pile"}, note};
  make_output_folder(request.of.out);
  std::vector<SearchResult> results;
  const auto check = [&](const ResolvedMission& mission) { expect_victims(mission, request.of.mission); };
  for_each_pile(piles, check, [&](const SeededPile& pile) {
    SearchRules rules;
    rules.radius = pile.mission.scenario.victims.radius;
    const SearchWorld world(pile.mission, pile.state, rules, pile.threads);
    for (const std::string& name : names) {
      const SearchScore score = play_search(world, pile.seed, *make_agent(request, name, world, pile.seed));
      note(text_of(pile.seed, name, score));
      results.push_back({pile.seed, name, score});
    }
  });
  return results;
}

std::vector<ScoreRow> list_searches(const std::vector<SearchResult>& results) {
  std::vector<ScoreRow> rows;
  for (const SearchResult& r : results) {
    const SearchScore& s = r.score;
    rows.push_back({r.agent,
                    {{"seed", "seed", double(r.seed), 0},
                     {"victims", "victims", double(s.victims), 0},
                     {"found", "found", double(s.found), 0},
                     {"false_reports", "false reports", double(s.false_reports), 0},
                     {"coverage", "coverage", s.coverage, 3},
                     {"spl", "SPL", s.spl, 3},
                     {"collisions", "collisions", double(s.collisions), 0},
                     {"path_m", "path, m", s.path, 2},
                     {"time_s", "time, s", s.time, 1},
                     {"failed", "failed", s.failure.empty() ? 0.0 : 1.0, 0}}});
  }
  return rows;
}

std::vector<ScoreRow> make_search_table(const std::vector<SearchResult>& results) {
  std::vector<std::string> names;
  for (const SearchResult& r : results)
    if (std::find(names.begin(), names.end(), r.agent) == names.end()) names.push_back(r.agent);
  std::vector<ScoreRow> rows;
  for (const std::string& name : names) {
    const auto mean = [&](auto&& value) {
      std::vector<double> values;
      for (const SearchResult& r : results)
        if (r.agent == name) values.push_back(double(value(r.score)));
      return calc_mean(values);
    };
    ScoreRow row{name, {}};
    const auto add = [&](const std::string& key, const std::string& heading, const MeanInterval& m, int digits) {
      row.cells.push_back({key, heading, m.mean, digits});
    };
    const auto add_interval = [&](const std::string& key, const std::string& heading, const MeanInterval& m) {
      add(key, heading, m, 3);
      row.cells.push_back({key + "_low", "from", m.low, 3});
      row.cells.push_back({key + "_high", "to", m.high, 3});
    };
    const auto count = std::count_if(results.begin(), results.end(), [&](const auto& r) { return r.agent == name; });
    row.cells.push_back({"searches", "searches", double(count), 0});
    add_interval("found_share", "found", mean([](const SearchScore& s) { return double(s.found) / s.victims; }));
    add_interval("spl", "SPL", mean([](const SearchScore& s) { return s.spl; }));
    add_interval("coverage", "coverage", mean([](const SearchScore& s) { return s.coverage; }));
    add("false_reports", "false reports", mean([](const SearchScore& s) { return s.false_reports; }), 2);
    add("collisions", "collisions", mean([](const SearchScore& s) { return s.collisions; }), 1);
    add("path_m", "path, m", mean([](const SearchScore& s) { return s.path; }), 1);
    add("time_s", "time, s", mean([](const SearchScore& s) { return s.time; }), 0);
    const MeanInterval failed = mean([](const SearchScore& s) { return s.failure.empty() ? 0 : 1; });
    row.cells.push_back({"failed_share", "failed", failed.mean, 2});
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace rubble
