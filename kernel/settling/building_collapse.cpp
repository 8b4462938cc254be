#include "kernel/settling/building_collapse.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/structure/building.h"
#include "kernel/structure/failure.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace {

constexpr double kSinkingTime = 2;     // of a footing; unit: s
constexpr double kSinkingStep = 0.05;  // each step is found by a solution of all stresses; unit: s

BuildingState describe_building(const World& world, int first, int count) {
  BuildingState state;
  state.first = first, state.count = count;
  for (int i = first; i < first + count; ++i) {
    const std::vector<int> bound = world.structures().bound_with(i);
    if (bound.size() < 2 || bound.front() != i || world.piece(i).status == PieceStatus::lost) continue;
    state.bodies.emplace_back(bound.begin(), bound.end());
  }
  state.ties = world.structures().ties();
  for (int i = 0; i < world.structures().tie_count(); ++i) state.tie_forces.push_back(float(world.structures().tie_force(i)));
  state.loads = world.structures().contact_loads();
  return state;
}

std::shared_ptr<const BuildingStructures> structures_of(const Pile& pile) {
  return pile.structures ? pile.structures : std::make_shared<const BuildingStructures>(build_structures(pile.building));
}

}  // namespace

BuildingCollapse::BuildingCollapse(World& world, const Pile& pile, const SettleOptions& options)
    : building_(pile.building),
      motion_(pile.building.cause, pile.building.seed, options.step),
      step_length_(options.step) {
  const BuildingSpec& building = building_;
  const auto built = structures_of(pile);
  const Structure& damaged = built->damaged;
  const std::vector<SectionForces> before = check_stands(built->whole, options.gravity);
  std::vector<SectionForces> settled;  // of the bonds that are left
  for (const std::int32_t bond : damaged.from_bond) settled.push_back(before[bond]);
  CollapseOptions collapse;
  collapse.gravity = options.gravity;
  collapse.step = options.step;
  collapse.continuity = building.continuity;
  collapse.shake = building.cause.shake;
  collapse_ = std::make_unique<Collapse>(world, damaged, pile.building_first_type, collapse, settled);
  if (building.cause.blast > 0) collapse_->blast(building.cause.blast_at, building.cause.blast);
  find_footings(damaged);
  if (building.cause.vehicle.mass > 0) drive_into(damaged);
}

std::vector<int> BuildingCollapse::find_column(const Structure& structure, int i, int j,
                                               const std::string& part) const {
  std::vector<int> members;
  for (std::size_t m = 0; m < structure.members.size(); ++m) {
    if (is_ground_column(structure.members[m], i, j, part)) members.push_back(int(m));
  }
  return members;
}

void BuildingCollapse::find_footings(const Structure& structure) {
  for (const SinkingFooting& f : building_.cause.sinking) {
    for (const int member : find_column(structure, f.i, f.j, f.part)) footings_.push_back({member, f.depth});
  }
}

// Into the widest of its members.
void BuildingCollapse::drive_into(const Structure& structure) {
  const StrikingVehicle& v = building_.cause.vehicle;
  const std::vector<int> members = find_column(structure, v.i, v.j, v.part);
  if (members.empty()) return;
  const auto width = [&](int m) { return std::max(structure.members[m].size.x, structure.members[m].size.y); };
  const int column = *std::max_element(members.begin(), members.end(), [&](int m, int n) { return width(m) < width(n); });
  const portable::SinCos direction = portable::sincos(v.direction_deg * portable::kPi / 180);
  Vec3 at = structure.members[column].centre;
  at.z = v.height;
  Striker striker;
  striker.direction = {direction.cos, direction.sin, 0};
  striker.mass = v.mass, striker.speed = v.speed;
  striker.force = v.speed * std::sqrt(v.stiffness * v.mass);
  collapse_->strike(column, at, striker);
}

// By even steps, so that the loads that move away from a footing find their new ways.
void BuildingCollapse::sink_footings() {
  const double time = double(step_) * step_length_;
  const std::int64_t every = std::max<std::int64_t>(1, std::llround(kSinkingStep / step_length_));
  if (footings_.empty() || time > kSinkingTime + kSinkingStep || step_ % every != 0) return;
  const double share = std::min(1.0, time / kSinkingTime);
  for (const auto& [column, depth] : footings_) collapse_->sink(column, depth * share);
}

bool BuildingCollapse::goes_on() const {
  const bool sinks = !footings_.empty() && double(step_) * step_length_ < kSinkingTime + kSinkingStep;
  return !motion_.over(step_) || sinks || collapse_->is_sinking() || collapse_->is_breaking();
}

BuildingState BuildingCollapse::state(const World& world) const {
  return describe_building(world, collapse_->first_piece(), collapse_->piece_count());
}

BuildingState find_building_state(const World& world, const Pile& pile) {
  const auto built = structures_of(pile);
  const Structure& building = built->damaged;
  const int type = pile.building_first_type, end = type + int(building.types.size());
  int first = 0;  // after what is placed
  while (first < world.size() && (world.piece(first).type < type || world.piece(first).type >= end)) ++first;
  return describe_building(world, first, int(building.pieces.size()));
}

void BuildingCollapse::before_step() {
  sink_footings();
  collapse_->begin_step(motion_.at(step_));
}

void BuildingCollapse::after_step() {
  collapse_->end_step();
  ++step_;
}

std::vector<PieceType> make_building_types(const BuildingSpec& building) {
  return build_structures(building).damaged.types;
}

}  // namespace rubble
