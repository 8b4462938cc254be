// The inside of World: its data, what works on them, and the order of a step. Not for use outside kernel/.
#pragma once

#include <functional>
#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/world/phases/advance.h"
#include "kernel/world/phases/contact_search.h"
#include "kernel/world/phases/contact_solution.h"
#include "kernel/world/phases/pair_selection.h"
#include "kernel/world/phases/sleep.h"
#include "kernel/world/phases/speed_limiter.h"
#include "kernel/world/phases/ties.h"
#include "kernel/world/phases/trees.h"
#include "kernel/world/robot_trees.h"
#include "kernel/world/state/groups.h"
#include "kernel/world/tubes.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {

struct World::Impl {
  Impl(std::vector<PieceType> piece_types, const WorldOptions& world_options,
       std::vector<AssemblyType> assembly_types);

  WorldTypes types;
  WorldSettings settings;
  ThreadPool pool;
  WorldData data;
  FreeBodies blocks;
  SimbodyTrees simbody_trees;
  std::function<bool()> on_solved;           // see World::set_on_solved()
  std::function<void(StepStage)> on_stage;  // see World::set_on_stage()

  // What the phases of the last step made; see phases/step.h.
  StepPairs step_pairs;
  StepMotions motions;
  std::vector<std::uint8_t> touched;  // by body, for note_touching()

  // Each has the data that it works on from its constructor, and what the step has so far as arguments.
  Bodies bodies{types, data, blocks};
  Waking waking{data, settings};
  Pairs pairs{types, data, bodies, waking};
  RigidGroups groups{data, bodies, blocks, pairs};
  WorldTrees trees{types, data, settings, bodies, blocks, simbody_trees, pool};
  Ties ties{data, settings, bodies, waking};
  PairSelection pair_selection{data, settings, bodies, pairs, pool};
  ContactSearch contact_search{data, settings, bodies, pool};
  ContactSolution solution{data, settings, blocks, pool};
  SpeedLimiter limits{data, settings, pool};
  Advance advance{data, settings, bodies, blocks, pool};
  Sleep sleep{data, settings, bodies, blocks, trees, waking, pool};
  Tubes tubes{types, data, bodies, pairs, trees, simbody_trees};
  RobotTrees robots{types, data, settings, pairs, waking, trees, tubes, simbody_trees};

  // world_step.cpp
  void begin_stage(StepStage stage);
  void find_contacts();
  void put_loads(const BuildingState& building);  // world_loads.cpp; on the contacts that were found last
  void solve();
  void note_touching();
  void lose(int body);
  void remove_lost();

  // world_resume.cpp
  void lay_to_rest(const PileState& state, const std::vector<TreeState>& tree_states);
};

}  // namespace rubble
