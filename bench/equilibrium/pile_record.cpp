#include "bench/equilibrium/pile_record.h"

#include <cmath>
#include <cstdio>

#include "bench/report.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

constexpr double kMillimetre = 1e3;   // per metre
constexpr std::size_t kNamedEjections = 5;
constexpr double kFarDrift = 0.020;   // no piece of a pile at rest should go farther; unit: m

// To so many parts of one.
double round_to(double value, double parts) { return std::round(value * parts) / parts; }
double in_mm(double metres) { return round_to(metres * kMillimetre, 1e3); }

void add_settling(const Work& work, const SettleRun& run, Record& record) {
  const PileState& state = run.state;
  int moving = 0;
  for (const PieceState& piece : state.pieces) moving += piece.status == PieceStatus::moving;
  record["work"] = work.name;
  record["seed"] = work.seed;
  record["schedule"] = name_of(run.schedule);
  record["pieces"] = state.pieces.size();
  record["settled"] = state.settled;
  record["layers_at_limit"] = state.layers_at_limit;
  record["moving"] = moving;
  record["simulated_s"] = round_to(state.simulated, 1e4);
  record["steps"] = state.steps;
  record["cpu_s"] = round_to(run.cpu, 1e3);
  record["wall_s"] = round_to(run.wall, 1e3);
  record["lost"] = state.lost;
  record["ejected"] = run.ejected.size();
  for (std::size_t i = 0; i < run.ejected.size() && i < kNamedEjections; ++i) {
    const Ejection& e = run.ejected[i];
    char text[160];
    std::snprintf(text, sizeof text, "%s in step %lld: %.1f to %.1f m/s, z %.2f m", name_of_piece(state, e.piece).c_str(),
                  static_cast<long long>(e.step), std::sqrt(dot(e.before, e.before)), std::sqrt(dot(e.after, e.after)), e.place.z);
    record["first_ejected"].push_back(text);
  }
  record["state_hash"] = hex64(state.state_hash());
}

void add_overlaps(const SettleRun& run, Record& record) {
  const OverlapReport& o = run.overlaps;
  record["touching_pairs"] = o.touching_pairs;
  record["over_5mm"] = o.count_deeper(0.005);
  record["overlap_p99_mm"] = in_mm(o.percentile_depth(99));
  record["overlap_max_mm"] = in_mm(o.max_depth());
  if (!o.overlaps.empty()) {
    const Overlap& deepest = o.overlaps.front();
    record["deepest_pair"] = {name_of_piece(run.state, deepest.a),
                              name_of_piece(run.state, deepest.b)};
  }
  record["ground_max_mm"] = in_mm(o.ground_max);
  if (o.deepest_in_ground >= 0)
    record["deepest_in_ground"] = name_of_piece(run.state, o.deepest_in_ground);
}

void add_drift(const SettleRun& run, Record& record) {
  int far = 0;
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < run.drift.size(); ++i) {
    far += run.drift[i] > kFarDrift;
    if (run.drift[i] > run.drift[farthest]) farthest = i;
  }
  record["drift_median_mm"] = in_mm(percentile(run.drift, 50));
  record["drift_p99_mm"] = in_mm(percentile(run.drift, 99));
  record["drift_max_mm"] = in_mm(percentile(run.drift, 100));
  record["drift_over_20mm"] = far;
  if (!run.drift.empty())
    record["farthest_drift"] = name_of_piece(run.state, run.drifted[farthest]);
}

}  // namespace

std::string name_of_piece(const PileState& state, int index) {
  const PieceState& piece = state.pieces[std::size_t(index)];
  return "#" + std::to_string(index) + " " + state.types[std::size_t(piece.type)];
}

Record make_record(const Work& work, const SettleRun& run) {
  Record record;
  add_settling(work, run, record);
  add_overlaps(run, record);
  add_drift(run, record);
  return record;
}

}  // namespace rubble
