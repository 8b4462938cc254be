// A pile's building in its world, from its cause on.
#pragma once

#include <cstdint>
#include <memory>

#include "kernel/model/pile.h"
#include "kernel/settling/collapse.h"
#include "kernel/settling/ground_motion.h"
#include "kernel/settling/settle.h"

namespace rubble {

class BuildingCollapse {
 public:
  // Adds the building's pieces to the world. Throws InputError where it does not stand by itself.
  BuildingCollapse(World& world, const Pile& pile, const SettleOptions& options);
  void before_step();
  void after_step();
  // The ground still moves, or bonds broke in the last step: what stands still is not at rest.
  bool goes_on() const { return !motion_.over(step_) || collapse_->is_breaking(); }
  CollapseReport report() const { return collapse_->report(); }

 private:
  GroundMotion motion_;
  std::unique_ptr<Collapse> collapse_;
  std::int64_t step_ = 0;
};

// The types of a building's pieces, in their order: Pile::types must have them from its
// building_first_type on. materials: by type, the name of each one's structural material; may be null.
std::vector<PieceType> make_building_types(const BuildingSpec& building,
                                           std::vector<std::string>* materials = nullptr);

}  // namespace rubble
