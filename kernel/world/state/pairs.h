// The pairs of parts that are near each other, with a contact for each. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/world/state/bodies.h"
#include "kernel/world/state/waking.h"

namespace rubble {

// Of two colliders; the second may be kGround.
std::uint64_t pair_key(std::int32_t a, std::int32_t b);

class Pairs {
 public:
  Pairs(const WorldTypes& types, WorldData& data, Bodies& bodies, Waking& waking)
      : types_(types), data_(data), bodies_(bodies), waking_(waking) {}

  // Makes bodies from there on known to all others.
  void introduce(int first);
  // Pairs of a body with all others; immovable ones need no pair among themselves.
  void find_first(int body);
  // Colliders, or kGround as the second; nothing where there is that pair already, or must be none.
  void add(int first, int second);
  void remove(std::size_t index);  // the last one takes its place
  template <typename If>
  void remove_if(If condition) {
    for (std::size_t i = 0; i < data_.pairs.size();) {
      if (condition(data_.pairs[i])) {
        remove(i);
      } else {
        ++i;
      }
    }
  }
  // A part near a surface has all slots there, far from it none.
  void update_near_surfaces(int collider);
  void list_surfaces();  // after bodies were added or restored

  // By a joint that lets its two links pass through each other.
  bool are_joined(int body_a, int body_b) const;

 private:
  void push(const Pair& pair);

  const WorldTypes& types_;
  WorldData& data_;
  Bodies& bodies_;
  Waking& waking_;
  std::vector<std::int32_t> surfaces_;  // the bodies that are one, ascending
  std::vector<std::int32_t> found_;     // of find_first()
};

}  // namespace rubble
