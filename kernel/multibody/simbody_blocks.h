// The kernel's first door to Simbody: free bodies in blocks, each a MultibodySystem with a State of
// its own that holds the coordinates q and the speeds u of up to 16 bodies. What is articulated is
// behind the second one, simbody_trees.h.
//
// Simbody owns the state and computes nothing here; contact impulses change u, and advance() changes q. Free bodies need
// nothing else of a State, so it is never realised beyond its model. The numbers of a sleeping body are never rewritten.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct FreeBody {
  double mass = 1;        // unit: kg
  Mat3 inertia;           // about the centre of mass, in the body; unit: kg m2
  Pose world_from_com;    // frame of the body's axes, in its centre of mass; unit: m
  Vec3 linear_velocity;   // of the centre of mass, in the world; unit: m/s
  Vec3 angular_velocity;  // in the world; unit: rad/s
};

// How a body moves in a step.
struct BodyRates {
  Vec3 linear, angular;              // speeds after the step; unit: m/s, rad/s
  Vec3 extra_linear, extra_angular;  // on top of them in the displacement only
  bool turns_freely = false;         // then this is where it has turned to, whatever the rates
  Quat rotation;                     // world from body, where turns_freely
};

class SimbodyBlocks {
 public:
  static constexpr int kBlockSize = 16;  // pieces that share one Simbody System: one alone is 20 times dearer

  SimbodyBlocks();
  ~SimbodyBlocks();
  SimbodyBlocks(SimbodyBlocks&&) noexcept;
  SimbodyBlocks& operator=(SimbodyBlocks&&) noexcept;

  // Adds bodies to fresh blocks, in this order; returns the number of the first one.
  int add(const std::vector<FreeBody>& bodies);
  int size() const { return size_; }
  int block_count() const;
  int block_of_body(int body) const { return block_index_[body]; }
  // Number of a block's first body; size() for the block after the last.
  int first_of(int block) const;

  // Speeds of one body.
  void set_velocity(int body, const Vec3& linear, const Vec3& angular);
  Vec3 linear_velocity(int body) const;
  Vec3 angular_velocity(int body) const;

  // Moves the bodies of one block that `moves` marks (indexed by body) for the time `dt` by their
  // new speeds u plus the extra displacement rates. Blocks are independent of each other: different
  // threads may advance different blocks.
  void advance(int block, const std::vector<std::uint8_t>& moves, const BodyRates* rates, double dt);
  Pose world_from_com(int body) const;

  // Puts a body somewhere, bit for bit; used to restore a state.
  void set_pose(int body, const Pose& world_from_com);

 private:
  struct Block;
  Block& block_of(int body) const;

  std::vector<std::unique_ptr<Block>> blocks_;
  std::vector<std::int32_t> block_index_, slot_;  // of each body
  int size_ = 0;
};

}  // namespace rubble
