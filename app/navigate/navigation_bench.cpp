#include "app/navigate/navigation_bench.h"

#include <algorithm>
#include <cstdio>

#include "app/batch/seed_list.h"
#include "app/eval/scores/confidence.h"
#include "app/navigate/mission_to_drive.h"
#include "app/pipeline/seeded_piles.h"
#include "io/base/atomic_file.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

std::string text_of(std::uint64_t seed, const NavigationScore& s) {
  char text[200];
  std::snprintf(text, sizeof text, "seed %llu: %s after %.1f s and %.1f m (%.1f m in the void), %d collisions",
                static_cast<unsigned long long>(seed), name_of(s.end).c_str(), s.time, s.path, s.inside, s.collisions);
  return text;
}

bool parse_planner(const std::string& name) {
  if (name == "ompl" || name == "none") return name == "ompl";
  throw InputError({"", 0, "--planner", "no such planner", "none or ompl", "\"" + name + "\"", ""});
}

// For drawings: where the robot was, where it drove to, and the goal of the mission.
void write_way(const std::string& path, const NavigationWorld& world, const NavigationScore& score) {
  std::string text = "time_s,x,y,yaw,target_x,target_y,goal_x,goal_y\n";
  double time = 0;
  for (const NavigationStep& step : score.way) {
    char line[200];
    std::snprintf(line, sizeof line, "%.1f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", time, step.base.x, step.base.y, step.yaw,
                  step.target.x, step.target.y, world.goal().x, world.goal().y);
    text += line;
    time += world.rules().period;
  }
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

std::vector<NavigationResult> run_navigation_bench(const NavigationBenchRequest& request,
                                                   const std::function<void(const std::string&)>& note) {
  const SeededPiles piles{request.of, parse_seeds(request.seeds, "--seeds"), {"pile"}, note};
  const bool plans = parse_planner(request.planner);
  const std::string cache = request.of.out + "/arcs.part";
  make_output_folder(request.of.out);
  remove_output_folder(cache);  // of a bench that was killed
  for (const char* folder : {"ways", "missions", "arcs.part"}) make_folder_below(request.of.out, folder);
  std::vector<NavigationResult> results;
  for_each_pile(piles, [](const ResolvedMission&) {}, [&](const SeededPile& pile) {
    NavigationRules rules;
    rules.plans = plans;
    const NavigationWorld world(pile.mission, pile.state, rules, pile.threads);
    write_mission_to_drive(request.of.out + "/missions", pile.seed, world, !request.of.asset_packs.empty());
    if (request.missions_only) return results.push_back({pile.seed, {}});
    results.push_back({pile.seed, navigate(world, pile.seed, cache)});
    write_way(request.of.out + "/ways/" + std::to_string(pile.seed) + ".csv", world, results.back().score);
    note(text_of(pile.seed, results.back().score));
  });
  remove_output_folder(cache);
  return results;
}

std::vector<ScoreRow> list_missions(const std::vector<NavigationResult>& results) {
  std::vector<ScoreRow> rows;
  for (const NavigationResult& r : results) {
    const NavigationScore& s = r.score;
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(s.hash));
    rows.push_back({hash,
                    {{"seed", "seed", double(r.seed), 0},
                     {"arrived", "arrived", s.end == NavigationEnd::arrived ? 1.0 : 0.0, 0},
                     {"gave_up", "gave up", s.end == NavigationEnd::gave_up ? 1.0 : 0.0, 0},
                     {"fell", "fell over", s.end == NavigationEnd::fell ? 1.0 : 0.0, 0},
                     {"passes", "through", s.passes ? 1.0 : 0.0, 0},
                     {"shortest_m", "shortest, m", s.shortest, 2},
                     {"path_m", "path, m", s.path, 2},
                     {"inside_m", "in the void, m", s.inside, 2},
                     {"left_m", "left, m", s.left, 2},
                     {"collisions", "collisions", double(s.collisions), 0},
                     {"periods", "periods", double(s.periods), 0},
                     {"plans", "plans", double(s.plans), 0},
                     {"plans_failed", "plans failed", double(s.plans_failed), 0},
                     {"time_s", "time, s", s.time, 2}}});
  }
  return rows;
}

std::vector<ScoreRow> make_navigation_table(const std::vector<NavigationResult>& results, bool with_clock) {
  ScoreRow row{"CReactiveNavigationSystem3D", {}};
  const auto mean = [&](auto&& value) {
    std::vector<double> values;
    for (const NavigationResult& r : results) values.push_back(double(value(r.score)));
    return calc_mean(values);
  };
  const auto add = [&](const std::string& key, const std::string& heading, double value, int digits) {
    row.cells.push_back({key, heading, value, digits});
  };
  const auto share = [&](NavigationEnd end) { return mean([=](const NavigationScore& s) { return s.end == end; }); };
  const MeanInterval arrived = share(NavigationEnd::arrived);
  add("missions", "missions", double(results.size()), 0);
  add("arrived_share", "arrived", arrived.mean, 3);
  add("arrived_share_low", "from", arrived.low, 3);
  add("arrived_share_high", "to", arrived.high, 3);
  add("gave_up_share", "gave up", share(NavigationEnd::gave_up).mean, 2);
  add("time_up_share", "time up", share(NavigationEnd::time_up).mean, 2);
  add("fell_share", "fell over", share(NavigationEnd::fell).mean, 2);
  add("collisions", "collisions", mean([](const NavigationScore& s) { return s.collisions; }).mean, 1);
  add("inside_m", "in the void, m", mean([](const NavigationScore& s) { return s.inside; }).mean, 1);
  add("path_m", "path, m", mean([](const NavigationScore& s) { return s.path; }).mean, 1);
  add("time_s", "time, s", mean([](const NavigationScore& s) { return s.time; }).mean, 1);
  add("plans", "plans", mean([](const NavigationScore& s) { return s.plans; }).mean, 1);
  if (!with_clock) return {row};
  double periods = 0, late = 0, slowest = 0;
  for (const NavigationResult& r : results) {
    periods += r.score.periods, late += r.score.late;
    slowest = std::max(slowest, r.score.slowest);
  }
  add("periods", "periods", periods, 0);
  add("deadlines_missed", "deadlines missed", late, 0);
  add("slowest_ms", "slowest, ms", 1000 * slowest, 0);
  return {row};
}

}  // namespace rubble
