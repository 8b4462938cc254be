#include "app/drive/inspect/inspected_pile.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/pipeline/stages.h"
#include "kernel/settling/building_collapse.h"

namespace rubble {
namespace {

SettleOptions with_threads(SettleOptions options, int threads) {
  options.threads = threads;
  return options;
}

}  // namespace

InspectedPile::InspectedPile(const ResolvedMission& mission, int threads)
    : mission_(mission),
      options_(with_threads(mission.scenario.settle, threads)),
      pile_(make_pile(mission)),
      world_(pile_.types, calc_world_options(options_), pile_.assemblies) {}

void InspectedPile::settle(const Between& between) {
  const auto step = [&](const SettleProgress& progress) {
    progress_ = progress;
    return between();
  };
  bool first = !started_, wanted = true;
  const auto observe = [&](const World&) {
    if (std::exchange(first, false)) wanted = between();
  };
  settling_ = true;
  if (!started_) {
    started_ = true;
    state_ = settle_pieces(world_, mission_, pile_, options_, [&](const SettleProgress& p) { return wanted && step(p); }, observe);
  } else {
    state_ = resume_settling(world_, make_rest_checkpoint(world_, pile_, options_), pile_, options_, step);
  }
  settling_ = false;
  progress_.make_checkpoint = nullptr;  // of a settling that is over
}

PileState InspectedPile::all_pieces() const {
  PileState all = state();
  if (pile_.building.given()) all.building = find_building_state(world_, pile_);
  int layers = 0;  // that are there
  for (const PieceState& piece : all.pieces) layers = std::max(layers, piece.layer + 1);
  for (std::size_t k = std::size_t(layers); k < pile_.layers.size(); ++k)
    for (const Placement& placement : pile_.layers[k].pieces) {
      PieceState piece;
      piece.layer = std::int32_t(k), piece.world_from_body = placement.world_from_body;
      piece.type = placement.kind.index, piece.scale = placement.scale;
      if (!placement.kind.is_assembly) all.pieces.push_back(piece);
      if (!placement.kind.is_assembly) continue;
      for (const AssemblyLink& link : pile_.assemblies[std::size_t(placement.kind.index)].links) {
        piece.type = link.type, piece.scale = placement.scale * link.scale;
        all.pieces.push_back(piece);
      }
    }
  return all;
}

PileState InspectedPile::state() const {
  PileState state;
  for (const PieceType& type : pile_.types) state.types.push_back(type.name);
  state.pieces = world_.pieces();
  state.joints = world_.joints();
  state.steps = world_.steps(), state.simulated = world_.time(), state.lost = world_.lost_count();
  return state;
}

bool InspectedPile::can_save() const { return !settling_ || progress_.make_checkpoint; }

SettleCheckpoint InspectedPile::checkpoint() const {
  return settling_ ? progress_.make_checkpoint() : make_rest_checkpoint(world_, pile_, options_);
}

std::string InspectedPile::describe() const {
  char time[32];
  std::snprintf(time, sizeof time, "t %.2f s   ", world_.time());
  if (!settling_) return time + std::string(state_.settled ? "at rest" : "the time limit came");
  const std::string layer =
      progress_.layers > 0 ? "layer " + std::to_string(progress_.layer) + " of " + std::to_string(progress_.layers) + "   " : "";
  return time + layer +
         (progress_.verifying ? "verifying rest" : std::to_string(progress_.awake) + " of " + std::to_string(world_.size()) + " awake");
}

}  // namespace rubble
