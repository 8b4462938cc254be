#include "bench/report.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <numeric>

#include "kernel/base/hash.h"

namespace rubble {
namespace {

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char buffer[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(buffer, sizeof buffer, pattern, arguments);
  va_end(arguments);
  return buffer;
}

constexpr double kMillimetre = 1e3;  // per metre

std::string piece_text(const SettleRun& run, int index) {
  const PieceState& piece = run.state.pieces[std::size_t(index)];
  const Vec3& p = piece.world_from_body.translation;
  return format("#%d %s %.1f kg at (%.2f, %.2f, %.2f)", index,
                run.state.types[std::size_t(piece.type)].c_str(), run.masses[std::size_t(index)],
                p.x, p.y, p.z);
}

std::string deepest_text(const SettleRun& run, int count) {
  std::string text = "deepest overlaps\n";
  const auto& all = run.overlaps.overlaps;
  for (std::size_t i = 0; i < all.size() && int(i) < count; ++i) {
    text += format("  %7.2f mm  ", all[i].depth * kMillimetre) + piece_text(run, all[i].a) +
            "  and  " + piece_text(run, all[i].b) + "\n";
  }
  return text;
}

std::string moving_text(const SettleRun& run, int count) {
  std::vector<int> moving;
  for (std::size_t i = 0; i < run.state.pieces.size(); ++i) {
    if (run.state.pieces[i].status == PieceStatus::moving) moving.push_back(int(i));
  }
  std::string text = format("moving at the end: %d\n", int(moving.size()));
  for (std::size_t i = 0; i < moving.size() && int(i) < count; ++i) {
    const PieceState& piece = run.state.pieces[std::size_t(moving[i])];
    text += format("  %6.3f m/s %6.3f rad/s  ", norm(piece.linear_velocity),
                   norm(piece.angular_velocity)) +
            piece_text(run, moving[i]) + "\n";
  }
  return text;
}

std::string drift_text(const SettleRun& run, int count) {
  std::vector<std::size_t> order(run.drift.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&run](std::size_t i, std::size_t j) { return run.drift[i] > run.drift[j]; });
  std::string text = format("farthest drift in %.0f s awake\n", kDriftTime);
  for (std::size_t i = 0; i < order.size() && int(i) < count; ++i) {
    text += format("  %7.2f mm  ", run.drift[order[i]] * kMillimetre) +
            piece_text(run, run.drifted[order[i]]) + "\n";
  }
  return text;
}

std::string ejected_text(const SettleRun& run, int count) {
  std::string text = format("ejected: %d\n", int(run.ejected.size()));
  for (std::size_t i = 0; i < run.ejected.size() && int(i) < count; ++i) {
    const Ejection& e = run.ejected[i];
    text += format(
                "  step %lld at (%.2f, %.2f, %.2f), velocity (%.1f, %.1f, %.1f) to "
                "(%.1f, %.1f, %.1f) m/s: ",
                (long long)e.step, e.place.x, e.place.y, e.place.z, e.before.x, e.before.y,
                e.before.z, e.after.x, e.after.y, e.after.z) +
            piece_text(run, e.piece) + "\n";
  }
  return text;
}

}  // namespace

std::string name_of(Schedule schedule) {
  return schedule == Schedule::layers ? "layers" : "planes";
}

std::string csv_header() {
  return "work,schedule,threads,wall_s,cpu_s,sim_s,steps,settled,touching_pairs,over_5mm,over_10mm,"
         "overlap_mean_mm,overlap_p99_mm,overlap_max_mm,ground_max_mm,ejected,lost,"
         "drift_median_mm,drift_p99_mm,peak_rss_mib,state_hash";
}

std::string csv_line(const SettleRun& run) {
  const OverlapReport& o = run.overlaps;
  const PileState& s = run.state;
  std::string line = run.work + ',' + name_of(run.schedule) + ',' + std::to_string(run.threads);
  line += format(",%.3f,%.3f,%.4f,%lld,%d", run.wall, run.cpu, s.simulated, (long long)s.steps,
                 int(s.settled));
  line += format(",%d,%d,%d,%.3f,%.3f,%.3f,%.3f", o.touching_pairs, o.count_deeper(0.005),
                 o.count_deeper(0.010), o.mean_depth() * kMillimetre,
                 o.percentile_depth(99) * kMillimetre, o.max_depth() * kMillimetre,
                 o.ground_max * kMillimetre);
  line += format(",%d,%d,%.4f,%.4f,%.1f,", int(run.ejected.size()), s.lost,
                 percentile(run.drift, 50) * kMillimetre, percentile(run.drift, 99) * kMillimetre,
                 run.peak_rss);
  return line + hex64(s.state_hash());
}

std::string table_text(const SettleRun& run) {
  const OverlapReport& o = run.overlaps;
  const PileState& s = run.state;
  const auto time_of = [&run](StepStage stage) { return run.stages[std::size_t(stage)]; };
  std::string text = format("%s, schedule %s, threads %d, %d pieces\n", run.work.c_str(),
                            name_of(run.schedule).c_str(), run.threads, int(s.pieces.size()));
  text += format("  wall, CPU            %.2f s, %.2f s\n", run.wall, run.cpu);
  text += format("  simulated, steps     %.2f s, %lld (%.2f ms a step)\n", s.simulated,
                 (long long)s.steps, 1e3 * run.wall / double(std::max<std::int64_t>(s.steps, 1)));
  text += format(
      "  stages               broad %.2f, narrow %.2f, solve %.2f, advance %.2f, "
      "rest %.2f s\n",
      time_of(StepStage::pairs), time_of(StepStage::points), time_of(StepStage::impulses),
      time_of(StepStage::motion), time_of(StepStage::rest));
  text += format("  settled              %s; layers that ran into their limit: %d\n",
                 s.settled ? "yes" : "NO", s.layers_at_limit);
  text += format("  touching pairs       %d (closer than %.0f mm), %d overlap\n", o.touching_pairs,
                 kTouchGap * kMillimetre, int(o.overlaps.size()));
  text += format("  deeper than 5, 10 mm %d, %d\n", o.count_deeper(0.005), o.count_deeper(0.010));
  text += format("  overlap mean p99 max %.2f, %.2f, %.2f mm (libccd differs by up to %.4f mm)\n",
                 o.mean_depth() * kMillimetre, o.percentile_depth(99) * kMillimetre,
                 o.max_depth() * kMillimetre, o.largest_disagreement() * kMillimetre);
  text += format("  into the ground      %.2f mm\n", o.ground_max * kMillimetre);
  text += format("  ejected, lost        %d, %d\n", int(run.ejected.size()), s.lost);
  text += format("  drift median p99 max %.3f, %.3f, %.3f mm in %.0f s awake\n",
                 percentile(run.drift, 50) * kMillimetre, percentile(run.drift, 99) * kMillimetre,
                 percentile(run.drift, 100) * kMillimetre, kDriftTime);
  text += format("  peak memory          %.0f MiB\n", run.peak_rss);
  return text + "  state hash           " + hex64(s.state_hash()) + "\n";
}

std::string worst_text(const SettleRun& run, int count) {
  return deepest_text(run, count) + moving_text(run, count) + drift_text(run, count) +
         ejected_text(run, count);
}

}  // namespace rubble
