// Figures that describe a dataset at a glance: what suites set limits for and batches list.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"
#include "kernel/voids/void_map.h"
#include "render/scene/frame.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Name to value; the unit is the last word of the name. The same bits for the same dataset.
using Metrics = std::map<std::string, double>;

// Every name there is, with a line that says what it means.
const std::vector<std::pair<std::string, std::string>>& metric_names();

// Those of the pile.
void add_pile_metrics(const PileState& pile, const AssetLibrary& assets, Metrics& metrics);

// Those of the flight and of the depth over all its frames.
class DepthMetrics {
 public:
  // carriers: by camera, what it is on; "": the rig.
  explicit DepthMetrics(std::vector<std::string> carriers) : carriers_(std::move(carriers)) {}
  void add(const Frame& frame);
  void add_to(Metrics& metrics) const;

 private:
  std::int64_t frames_ = 0, pixels_ = 0, returns_ = 0;
  double min_ = 0, max_ = 0, sum_ = 0;
  struct Path {
    double length = 0;
    Vec3 last;
  };
  double flown() const;

  std::vector<std::string> carriers_;
  std::map<std::string, Path> paths_;  // by carrier
};

// The voids of a settled pile, for missions that ask for them (`voids.on`).

// What the mission asks of the map of voids.
VoidSpaceOptions make_void_options(const VoidScenario& voids);

// map: with the voids of a robot of that radius (unit: m).
void add_void_metrics(const VoidMap& map, double radius, Metrics& metrics);

}  // namespace rubble
