#include "kernel/settling/building_collapse.h"

#include "kernel/structure/frame_building.h"

namespace rubble {

BuildingCollapse::BuildingCollapse(World& world, const Pile& pile, const SettleOptions& options)
    : motion_(pile.building.cause, pile.building.seed, options.step) {
  const BuildingSpec& building = pile.building;
  validate(building);
  const Structure whole = build_building(building);
  std::vector<SectionForces> before = check_stands(whole, options.gravity);
  const Structure damaged = build_damaged(building, whole);
  std::vector<SectionForces> settled;  // of the bonds that are left
  for (const std::int32_t bond : damaged.from_bond) settled.push_back(before[bond]);
  CollapseOptions collapse;
  collapse.gravity = options.gravity;
  collapse.step = options.step;
  collapse_ = std::make_unique<Collapse>(world, damaged, pile.building_first_type, collapse, settled);
  if (building.cause.blast > 0) collapse_->blast(building.cause.blast_at, building.cause.blast);
}

void BuildingCollapse::before_step() { collapse_->begin_step(motion_.at(step_)); }

void BuildingCollapse::after_step() {
  collapse_->end_step();
  ++step_;
}

std::vector<PieceType> make_building_types(const BuildingSpec& building,
                                           std::vector<std::string>* materials) {
  validate(building);
  const Structure structure = build_damaged(building, build_building(building));
  if (materials) *materials = structure.type_materials;
  return structure.types;
}

}  // namespace rubble
