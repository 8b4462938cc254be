// Third phase of a step: the impulses at its contacts, ties and joints. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/solver/island_substeps.h"
#include "kernel/world/phases/speed_limiter.h"
#include "kernel/world/phases/ties.h"
#include "kernel/world/phases/trees.h"

namespace rubble {

class ContactSolution {
 public:
  ContactSolution(WorldData& data, const WorldSettings& settings, const FreeBodies& blocks, ThreadPool& pool)
      : data_(data), settings_(settings), blocks_(blocks), pool_(pool) {}

  // Sorts the active pairs, solves them with the trees and ties, and leaves the impulses in the contacts.
  // motions: receives velocities, displacements and lateness.
  void run(StepPairs& step, WorldTrees& trees, Ties& ties, const SpeedLimiter& limits, StepMotions& motions);
  // Whether it moved a body otherwise than its weight does, impulses aside.
  bool has_intervened(std::int32_t body) const {
    const int kind = islands_.kind_of(body);
    return (kind == IslandSubsteps::kHeap ? solver_ : finer_solvers_[kind]).has_intervened(body);
  }
  SweepFigures plan_sweeps(int threads) const { return solver_.plan_sweeps(threads, data_.bodies); }

 private:
  // Where a contact stands in the solver's order.
  struct OrderKey {
    float height = 0;  // unit: m
    std::int32_t collider_a = 0, collider_b = 0;
    std::int32_t index = 0;  // of the pair; decides nothing

    bool operator<(const OrderKey& k) const;
  };

  void turn_freely(const StepPairs& step, StepMotions& motions);
  void sort_by_height(StepPairs& step);
  void sort_keys();
  void solve_finer(int kind, const SolverSettings& settings, StepMotions& motions);

  WorldData& data_;
  const WorldSettings& settings_;
  const FreeBodies& blocks_;
  ThreadPool& pool_;
  IslandSubsteps islands_;
  ContactSolver solver_, finer_solvers_[kIslandKindCount];
  WantedList live_;
  std::vector<OrderKey> keys_, scratch_;
};

}  // namespace rubble
