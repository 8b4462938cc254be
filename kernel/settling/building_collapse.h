// A pile's building in its world, from its cause on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kernel/model/pile.h"
#include "kernel/settling/collapse.h"
#include "kernel/settling/ground_motion.h"
#include "kernel/settling/settle.h"
#include "kernel/structure/structure.h"

namespace rubble {

class BuildingCollapse {
 public:
  // Adds the building's pieces to the world. Throws InputError where it does not stand by itself.
  BuildingCollapse(World& world, const Pile& pile, const SettleOptions& options);
  void before_step();
  void after_step();
  // The ground still moves, or bonds broke in the last step: what stands still is not at rest.
  bool goes_on() const;
  CollapseReport report() const { return collapse_->report(); }
  // What of the building holds together now. world: the one that it collapses in.
  BuildingState state(const World& world) const;

 private:
  // Its members; none where it was removed. part: of a plan.
  std::vector<int> find_column(const Structure& structure, int i, int j, const std::string& part) const;
  void find_footings(const Structure& structure);
  void drive_into(const Structure& structure);
  void sink_footings();

  BuildingSpec building_;
  GroundMotion motion_;
  std::vector<std::pair<int, double>> footings_;  // members of columns, and how far each sinks; unit: m
  double step_length_;  // unit: s
  std::unique_ptr<Collapse> collapse_;
  std::int64_t step_ = 0;
};

// The types of a building's pieces, in their order: Pile::types must have them from its
// building_first_type on.
std::vector<PieceType> make_building_types(const BuildingSpec& building);
// BuildingCollapse::state() where the collapse itself is gone. world: the one that the pile's building collapsed in.
BuildingState find_building_state(const World& world, const Pile& pile);

}  // namespace rubble
