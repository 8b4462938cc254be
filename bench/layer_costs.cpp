#include "bench/layer_costs.h"

#include <cstdio>

namespace rubble {

void LayerCosts::note(const SettleProgress& progress, const Times& now, const StageTimes& stages) {
  if (layers_.empty() || layers_.back().layer != progress.layer || layers_.back().verifying != progress.verifying) {
    layers_.emplace_back();
  }
  LayerCost& cost = layers_.back();
  cost.layer = progress.layer, cost.verifying = progress.verifying, cost.pieces = progress.pieces;
  ++cost.steps;
  cost.awake += progress.awake;
  cost.time += now - before_;
  for (std::size_t i = 0; i < stages.size(); ++i) cost.stages[i] += stages[i] - stages_before_[i];
  before_ = now, stages_before_ = stages;
}

std::string layer_csv(const std::vector<LayerCost>& layers) {
  std::string text = "layer,verifying,pieces,steps,awake_piece_steps,cpu_s,pairs_s,points_s,impulses_s,motion_s,rest_s\n";
  for (const LayerCost& cost : layers) {
    char line[256];
    std::snprintf(line, sizeof line, "%d,%d,%d,%ld,%ld,%.3f", cost.layer, int(cost.verifying), cost.pieces, cost.steps,
                  cost.awake, cost.time.cpu);
    text += line;
    for (const double stage : cost.stages) {
      std::snprintf(line, sizeof line, ",%.3f", stage);
      text += line;
    }
    text += '\n';
  }
  return text;
}

}  // namespace rubble
