// A mission's pile that settles while a person looks on, stops it and pulls at it.
//
// It is the settling of `rubble settle`: nothing here steps a world. When all rests, settling can go on from there, as
// after a pull.
#pragma once

#include <functional>
#include <string>

#include "app/mission/resolved_mission.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"

namespace rubble {

class InspectedPile {
 public:
  // The mission must outlive it. threads: at least 1.
  InspectedPile(const ResolvedMission& mission, int threads);

  // Called before the first step and after each one; false: settle() returns.
  using Between = std::function<bool()>;
  // Settles from the start or the mission's snapshot; called again, it goes on from where the pile is. Returns when all
  // rests, when a time limit came, or when `between` said so. Throws InputError as settle_pieces() does.
  void settle(const Between& between);

  const World& world() const { return world_; }
  World& world() { return world_; }  // to be pulled at, in `between` or when settle() is over
  bool settling() const { return settling_; }
  bool settled() const { return state_.settled; }  // the last settle() ended at rest
  // Every piece, also those that fall later, by their numbers. To be drawn; of the start.
  PileState all_pieces() const;
  // The pieces that are there, as they are now.
  PileState state() const;
  // As settling ended.
  const PileState& rested() const { return state_; }

  // Whether the moment can be saved, and why not.
  bool can_save() const;
  SettleCheckpoint checkpoint() const;
  std::string describe() const;  // how far settling is, in a few words

 private:
  const ResolvedMission& mission_;
  SettleOptions options_;
  Pile pile_;
  World world_;
  PileState state_;
  SettleProgress progress_;
  bool started_ = false, settling_ = false;
};

}  // namespace rubble
