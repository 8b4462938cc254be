// The kernel's second door to Simbody: trees of bodies joined by Free, Ball, Pin, Slider and Weld
// mobilizers, each a MultibodySystem with a State of its own that holds the tree's q and u.
//
// As with free bodies, Simbody keeps the state and computes nothing that reaches a result: its
// arithmetic is compiled elsewhere, with other last bits on other machines. The same systems are
// the judges of ours in the tests.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/collision/body.h"
#include "kernel/multibody/tree.h"

namespace rubble {

class SimbodyTrees {
 public:
  SimbodyTrees();
  ~SimbodyTrees();
  SimbodyTrees(SimbodyTrees&&) noexcept;
  SimbodyTrees& operator=(SimbodyTrees&&) noexcept;

  // Adds a tree with the next number; `bodies` give the masses. A tree without links has no system.
  int add(const Tree& tree, const std::vector<Body>& bodies, const TreeState& state);
  // Puts another tree in the place of one that broke.
  void replace(int index, const Tree& tree, const std::vector<Body>& bodies,
               const TreeState& state);
  int size() const { return int(systems_.size()); }

  TreeState state(int index) const;
  // q and u in the order of the tree's links. Different threads may write different trees.
  void set_state(int index, const TreeState& state);

  // By Simbody's own arithmetic, for tests: world_from_com of a link, and du/dt under gravity
  // along -Z without springs.
  Pose calc_simbody_pose(int index, int link) const;
  std::vector<double> calc_simbody_accelerations(int index, double gravity) const;

 private:
  struct System;
  std::vector<std::unique_ptr<System>> systems_;
};

}  // namespace rubble
