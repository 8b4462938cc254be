// Figures that describe a dataset at a glance: what suites set limits for and batches list.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/asset_library.h"
#include "kernel/pile_state.h"
#include "render/frame.h"

namespace rubble {

// Name to value; the unit is the last word of the name. The same bits for the same dataset.
using Metrics = std::map<std::string, double>;

// "pile_height_m": highest point of all pieces but the lost; "pile_radius_m": of the smallest
// circle about the Z axis that holds the origins of 95 % of the pieces that were dropped;
// "piece_volume_m3": of all of them together; "pieces", "pieces_lost", "pieces_moving", "settled"
// (1 or 0), "simulated_s".
void add_pile_metrics(const PileState& pile, const AssetLibrary& assets, Metrics& metrics);

// Depth over all frames: "frames", "depth_min_m", "depth_mean_m", "depth_max_m", and
// "depth_none_share", the share of pixels without a return; "path_m", the length of the flight.
class DepthMetrics {
 public:
  void add(const Frame& frame);
  void add_to(Metrics& metrics) const;

 private:
  std::int64_t frames_ = 0, pixels_ = 0, returns_ = 0;
  double min_ = 0, max_ = 0, sum_ = 0, path_ = 0;
  Vec3 last_position_;
};

}  // namespace rubble
