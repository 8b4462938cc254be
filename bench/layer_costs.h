// What each layer of a pile costs until the next one falls.
#pragma once

#include <string>
#include <vector>

#include "bench/process_times.h"
#include "bench/stage_clock.h"
#include "kernel/settling/settle.h"

namespace rubble {

struct LayerCost {
  int layer = 0;     // layers that have fallen
  bool verifying = false;  // of the last layer: since rest is verified
  int pieces = 0;
  long steps = 0;
  long awake = 0;  // pieces, summed over the steps
  Times time;
  StageTimes stages{};
};

// Adds up the steps of a settling.
class LayerCosts {
 public:
  // After each step; now: what the settling has taken so far.
  void note(const SettleProgress& progress, const Times& now, const StageTimes& stages);

  const std::vector<LayerCost>& layers() const { return layers_; }

 private:
  std::vector<LayerCost> layers_;
  Times before_;
  StageTimes stages_before_{};
};

// Comma-separated lines below a line of names.
std::string layer_csv(const std::vector<LayerCost>& layers);

}  // namespace rubble
