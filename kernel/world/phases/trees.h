// Articulated trees in the world: made from assemblies, moved once a step, asleep or awake as a whole,
// broken at their joints. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/multibody/simbody_trees.h"
#include "kernel/multibody/tree_motion.h"
#include "kernel/world/phases/step.h"
#include "kernel/world/state/pairs.h"

namespace rubble {

class WorldTrees {
 public:
  WorldTrees(const WorldTypes& types, WorldData& data, const WorldSettings& settings, Bodies& bodies,
             FreeBodies& blocks, SimbodyTrees& simbody, ThreadPool& pool)
      : types_(types),
        data_(data),
        settings_(settings),
        bodies_(bodies),
        blocks_(blocks),
        simbody_(simbody),
        pool_(pool) {}

  void add_assembly(const NewPiece& piece);
  // Adds the links' bodies and joins them; start() then makes the tree part of the world.
  Tree make(const AssemblyType& assembly, const NewPiece& piece);
  // joint_positions: of the links with a joint of one coordinate, in their order; empty: as designed.
  void start(const Tree& tree, const NewPiece& piece, const std::vector<double>& joint_positions);
  // Joins the bodies that the joints of a settled pile connect (kernel/world/world_resume.cpp).
  void join_settled(const Pile& pile, const PileState& state);
  // Exchanges a tree for another at these coordinates; of an empty one nothing is left in Simbody.
  void replace(int tree, const Tree& by, const TreeState& state);

  // The phases of a step. begin() takes up the awake trees, and says which of them the solver moves.
  void begin(const StepPairs& step);
  const SolvedTrees& solved() const { return solved_; }
  void note_touching(const StepPairs& step);  // what hangs on something that touches is held too
  void advance();
  // The two pieces of a broken joint touch each other from the next step on. Where they overlap, as a bar
  // does that was cast into a slab, they are pushed apart as any others are.
  void break_joints(Pairs& pairs);

  // Poses and speeds of the links from what Simbody holds, after it was changed from outside.
  void mirror_state(int tree);
  void keep_whole(std::vector<std::uint8_t>& slept) const;  // nobody falls asleep before all of its tree do
  void stop(int tree);
  // The tree of a link that has left the world is no more; returns its bodies.
  std::vector<std::int32_t> dissolve(int tree);
  void set_motion(int body, const Vec3& linear, const Vec3& angular);
  void set_pose(int body, const Pose& world_from_com);
  // See World::apply_impulse() and World::impulse_response().
  void apply_impulse(int body, const Vec3& point, const Vec3& impulse);
  Mat3 impulse_response(int body, const Vec3& point) const;

 private:
  bool is_awake(const Tree& tree) const;
  void mirror_link(TreeLink& link, const Pose& world_from_com);
  void mirror_tree(int tree, const TreeMotion& motion);
  // In tree_breaking.cpp:
  void open_loops(int tree);
  void split(int tree, const std::vector<std::uint8_t>& broken);
  void release(const TreeLink& link);

  const WorldTypes& types_;
  WorldData& data_;
  const WorldSettings& settings_;
  Bodies& bodies_;
  FreeBodies& blocks_;
  SimbodyTrees& simbody_;
  ThreadPool& pool_;
  std::vector<TreeMotion> motions_;  // by number of the tree
  std::vector<std::int32_t> awake_;
  std::vector<std::uint8_t> is_solved_;  // by number of the tree
  std::vector<std::int32_t> released_;   // a body of each joint that broke in this step
  SolvedTrees solved_;
};

}  // namespace rubble
