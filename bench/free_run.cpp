#include "bench/free_run.h"

#include <algorithm>
#include <cstdio>

#include "bench/process_times.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

PileState state_of(const World& world) {
  PileState state;
  state.pieces = world.pieces();
  return state;
}

int add_pieces(World& world, const Pile& pile) {
  std::vector<NewPiece> pieces;
  const auto add = [&](const Placement& placement) { pieces.emplace_back().placement = placement; };
  for (const Placement& placement : pile.placed) add(placement);
  const std::size_t fixed = pieces.size();
  for (const Layer& layer : pile.layers)
    for (const Placement& placement : layer.pieces) add(placement);
  world.add(pieces);
  return int(pieces.size() - fixed);
}

FreeRun run_once(const Pile& pile, const SettleJob& job, int steps, bool sleeps, int threads) {
  WorldOptions options = calc_world_options(job.options);
  options.threads = threads;
  World world(pile.types, options, pile.assemblies);
  FreeRun run;
  run.work = job.work;
  run.threads = threads;
  run.steps = steps;
  run.sleeps = sleeps;
  run.pieces = add_pieces(world, pile);
  world.set_sleeping(sleeps);
  Times sum;
  for (int i = 0; i < steps; ++i) {
    const Times before = read_times();
    world.step();
    const Times spent = read_times() - before;
    sum += spent;
    run.slowest = std::max(run.slowest, 1e3 * spent.wall);
    run.awake_body_steps += world.awake_count();
  }
  run.wall = 1e3 * sum.wall / steps, run.cpu = 1e3 * sum.cpu / steps;
  run.peak_rss = read_peak_rss();
  const PileState state = state_of(world);
  for (const PieceState& piece : state.pieces) run.fastest_piece = std::max(run.fastest_piece, norm(piece.linear_velocity));
  run.state_hash = state.state_hash();
  if (job.judge) run.overlaps = check_overlaps(pile.types, state);
  return run;
}

std::string format(const char* pattern, const FreeRun& run) {
  const double body_steps = double(std::max<std::int64_t>(run.awake_body_steps, 1));
  const OverlapReport& o = run.overlaps;
  char text[768];
  std::snprintf(text, sizeof text, pattern, run.work.c_str(), run.threads, run.pieces, run.steps, int(run.sleeps),
                (long long)run.awake_body_steps, run.wall, run.cpu, run.slowest, 1e3 * run.wall * run.steps / body_steps,
                run.fastest_piece, o.touching_pairs, o.count_deeper(0.005), 1e3 * o.percentile_depth(99), 1e3 * o.max_depth(),
                run.peak_rss, hex64(run.state_hash).c_str());
  return text;
}

}  // namespace

std::vector<FreeRun> run_free(const Pile& pile, const SettleJob& job, int steps, bool sleeps, const std::vector<int>& threads) {
  std::vector<FreeRun> runs;
  for (const int count : threads) {
    runs.push_back(run_once(pile, job, steps, sleeps, count));
    if (runs.back().state_hash != runs.front().state_hash)
      throw RunError("the state depends on the number of threads: the same work must give the same bits");
  }
  return runs;
}

std::string free_csv_header() {
  return "work,threads,pieces,steps,sleeps,awake_body_steps,ms_per_step,cpu_ms_per_step,slowest_ms,us_per_awake_body_step,"
         "fastest_piece,touching_pairs,over_5mm,overlap_p99_mm,overlap_max_mm,peak_rss_mib,state_hash";
}

std::string free_csv_line(const FreeRun& run) {
  return format("%s,%d,%d,%d,%d,%lld,%.4f,%.4f,%.4f,%.4f,%.4f,%d,%d,%.3f,%.3f,%.1f,%s", run);
}

std::string free_text(const FreeRun& run) {
  return format("%s on %d threads: %d pieces, %d steps (sleep: %d), %lld piece-steps awake\n"
                "  ms a step: wall %.3f, CPU %.3f, slowest %.3f; us per awake piece %.3f; fastest piece at the end %.3f m/s\n"
                "  %d touching pairs, %d deeper than 5 mm, 99 %% %.3f mm, deepest %.3f mm; peak memory %.0f MiB; state %s\n",
                run);
}

}  // namespace rubble
