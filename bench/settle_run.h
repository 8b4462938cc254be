// One settling run of the bench: timed, watched for ejected pieces, and continued with everything
// awake to see how far it drifts.
#pragma once

#include <string>
#include <vector>

#include "bench/ejection_watch.h"
#include "bench/layer_costs.h"
#include "bench/overlap_checker.h"
#include "bench/stage_clock.h"
#include "kernel/model/pile.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"

namespace rubble {

// Length of the continuation with sleeping off. unit: s
inline constexpr double kDriftTime = 2.0;

struct SettleRun {
  std::string work;
  Schedule schedule = Schedule::layers;
  int threads = 1;

  double wall = 0, cpu = 0;  // making the world and settling, without what the bench adds; unit: s
  StageTimes stages{};       // of the settling alone
  std::vector<LayerCost> layers;
  double peak_rss = 0;       // of the process, when the pile rests; unit: MiB

  PileState state;
  std::vector<double> masses;     // by piece; 0: immovable; unit: kg
  std::vector<Ejection> ejected;  // one per piece that was ever faster than kEjectionSpeed
  OverlapReport overlaps;
  std::vector<double> drift;  // by piece, lost ones left out; unit: m
  std::vector<int> drifted;   // the pieces that these values belong to
};

struct SettleJob {
  std::string work;  // its name in the report
  SettleOptions options;
  bool judge = true;  // overlaps and drift; they take longer than settling
  bool drift = true;  // with judge: drift, too
};

SettleRun run_settling(const Pile& pile, const SettleJob& job);

}  // namespace rubble
