// The kernel's door to Simbody: a tree of bodies joined by mobilizers as a MultibodySystem,
// with a State that holds the tree's q and u.
//
// Simbody computes what is articulated: where the links are, their inertias and hinge matrices in
// the world, the forces of gravity and of motion (Coriolis, centrifugal, gyroscopic), and M^-1.
// What it calls must not depend on the processor, so a hinge takes sine and cosine from
// portable_math, and a free root is a Translation with a Ball (joints/). Then results have the same
// bits wherever Simbody was compiled without fused multiply-adds: see simbody_build.h.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/collision/body.h"
#include "kernel/multibody/tree.h"

namespace rubble {

class SimbodyTree {
 public:
  // `bodies` give the masses.
  SimbodyTree(const Tree& tree, const std::vector<Body>& bodies);
  ~SimbodyTree();
  SimbodyTree(const SimbodyTree&) = delete;
  SimbodyTree& operator=(const SimbodyTree&) = delete;

  // q and u in the order of the tree's links.
  TreeState state() const;
  void set_state(const TreeState& state);
  void set_speeds(const std::vector<double>& u);

  // At the coordinates of the state; kept until they change.
  const TreePose& pose();
  void calc_world_from_links(std::vector<Pose>& poses);

  // Generalized forces of gravity (along -Z; unit: m/s2) and of motion at the present u.
  void calc_forces(double gravity, std::vector<double>& forces);
  // M^-1 times a vector with a number for each speed.
  void multiply_by_inverse_mass(const std::vector<double>& forces,
                                std::vector<double>& accelerations);

 private:
  struct System;
  std::unique_ptr<System> system_;
};

// The trees of a world by number. One that came apart keeps its number, without a system.
class SimbodyTrees {
 public:
  int add(const Tree& tree, const std::vector<Body>& bodies, const TreeState& state);
  // Puts another tree in the place of one that broke.
  void replace(int index, const Tree& tree, const std::vector<Body>& bodies,
               const TreeState& state);
  int size() const { return int(trees_.size()); }

  SimbodyTree& at(int index) { return *trees_[std::size_t(index)]; }
  // Empty for a tree that came apart.
  TreeState state(int index) const;
  // Different threads may write different trees.
  void set_state(int index, const TreeState& state) { at(index).set_state(state); }

 private:
  std::vector<std::unique_ptr<SimbodyTree>> trees_;
};

}  // namespace rubble
