// collapse_bench: a building from its cause to checked rest, and how much of the time its stresses take.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "bench/calibration.h"
#include "kernel/settling/building_collapse.h"
#include "kernel/settling/settle.h"

namespace rubble {
namespace {

struct Request {
  std::string cause = "corner", kind = "frame";
  int threads = 2, storeys = 4, bays = 3;
  double piece = 0.8, limit = 20, overload = 1500, weakness = 0.2, shake = 4, column = 0.4, blast = 2000, continuity = 0.5,
         bars = -1, sinks = 0.1, vehicle = 20000;  // bars below 0: as buildings have them
  bool bare = false;
  std::uint64_t seed = 1;
};

BuildingSpec make_building(const Request& request) {
  BuildingSpec b;
  b.storeys = request.storeys;
  b.bays_x = b.bays_y = request.bays;
  b.piece = request.piece;
  b.column = request.column;
  b.seed = request.seed;
  b.continuity = request.continuity;
  if (request.bars >= 0) b.beam_bars = b.slab_bars = request.bars;
  if (request.bare) b.infill = Infill::none;
  if (request.kind == "masonry") b.kind = BuildingKind::masonry;
  if (request.kind == "precast") b.kind = BuildingKind::precast, b.infill = Infill::none;
  if (request.kind == "bridge") {
    b.kind = BuildingKind::bridge;
    b.storeys = 1, b.storey_height = 6.5, b.column = 0.9, b.beam_depth = 1.2, b.slab = 0.22;
    b.span_x = 14, b.span_y = 2.4;
  }
  if (request.kind == "parts") {
    b.partitions = Infill::brick, b.parapet = 0.9;
    b.stairs = {{0, 0}}, b.cores = {{1, 1}};
  }
  CollapseCause& c = b.cause;
  if (request.cause == "corner") c.removed = {{0, 0, 0}};
  if (request.cause == "edge") c.removed = {{0, 1, 0}};
  if (request.cause == "interior") c.removed = {{0, 1, 1}};
  if (request.cause == "side") {
    for (int j = 0; j <= b.bays_y; ++j) c.removed.push_back({0, 0, j});
  }
  if (request.cause == "storey") c.weak_storey = 0, c.weakness = request.weakness;
  if (request.cause == "overload") c.overloaded_floor = b.storeys - 1, c.overload = request.overload;
  if (request.cause == "shake") c.shake = request.shake, c.weak_storey = 0, c.weakness = request.weakness;
  if (request.cause == "blast") c.blast = request.blast, c.blast_at = {0, -b.bays_y * b.span_y / 2 - 1.5, 1};
  if (request.cause == "sinking") {
    for (int j = 0; j <= b.bays_y; ++j) c.sinking.push_back({0, j, request.sinks});
  }
  if (request.cause == "vehicle") c.vehicle.mass = request.vehicle;
  return b;
}

int run(const Request& request) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  std::fputs(calibration_text(calibrate()).c_str(), stdout);
  Pile pile;
  pile.building = make_building(request);
  auto start = Clock::now();
  pile.types = make_building_types(pile.building);
  std::printf("%zu types, %.2f s\n", pile.types.size(), seconds(start));
  SettleOptions options;
  options.threads = request.threads;
  options.final_time_limit = request.limit;
  CollapseReport report;
  int steps = 0;
  start = Clock::now();
  const PileState state = settle_pile(pile, options, [&](const SettleProgress& p) {
    report = p.collapse;
    if (++steps % 60 == 0) {
      std::printf("  %5.2f s simulated, %6.2f s: %d awake, %d broken, %d hinges, %d ties of which %d tore, %d solutions %.2f s\n",
                  p.simulated, seconds(start), p.awake, report.broken, report.hinges, report.ties, report.torn,
                  report.solutions, report.stress_seconds);
      std::fflush(stdout);
    }
    return true;
  });
  double top = 0, far = 0;
  int fixed = 0;
  for (const PieceState& piece : state.pieces) {
    const Vec3& p = piece.world_from_body.translation;
    top = std::max(top, p.z);
    far = std::max({far, std::abs(p.x), std::abs(p.y)});
    fixed += piece.status == PieceStatus::fixed;
  }
  std::printf("%s: %zu pieces, %d bonds, %d broken, %d hinges; %s after %.1f s simulated; %d stand; "
              "top %.1f m, extent %.1f m; deepest overlap %.1f mm; %.0f kJ taken by impacts, %.0f kJ by bars; "
              "%d ties, %d tore\n",
              request.cause.c_str(), state.pieces.size(), report.bonds, report.broken, report.hinges,
              state.settled ? "at rest" : "not at rest", state.simulated, fixed, top, far,
              1e3 * state.deepest_overlap.depth, report.energy_taken / 1e3, report.tie_energy / 1e3, report.ties,
              report.torn);
  std::printf("wall %.1f s, stresses %.2f s in %d solutions, hash %016llx\n", seconds(start),
              report.stress_seconds, report.solutions, (unsigned long long)state.state_hash());
  return 0;
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  rubble::Request request;
  CLI::App app("A building from its cause to checked rest");
  app.add_option("--cause", request.cause, "none corner edge interior side storey overload shake blast sinking vehicle");
  app.add_option("--kind", request.kind, "frame masonry precast bridge, or parts: a frame with all that it may have");
  app.add_option("--threads", request.threads, "threads");
  app.add_option("--storeys", request.storeys, "storeys");
  app.add_option("--bays", request.bays, "bays along X and Y");
  app.add_option("--piece", request.piece, "length of pieces; m");
  app.add_option("--column", request.column, "edge of columns; m");
  app.add_option("--seed", request.seed, "seed");
  app.add_option("--limit", request.limit, "simulated time; s");
  app.add_option("--overload", request.overload, "kg/m2");
  app.add_option("--weakness", request.weakness, "share of strength");
  app.add_option("--shake", request.shake, "m/s2");
  app.add_option("--blast", request.blast, "N s/m2 at 1 m");
  app.add_option("--continuity", request.continuity, "share of bars that hold on");
  app.add_option("--bars", request.bars, "bars of beams and slabs, as a share of their sections");
  app.add_flag("--bare", request.bare, "no walls");
  app.add_option("--sinks", request.sinks, "depth of sinking footings; m");
  app.add_option("--vehicle", request.vehicle, "kg");
  CLI11_PARSE(app, argc, argv);
  try {
    return rubble::run(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
