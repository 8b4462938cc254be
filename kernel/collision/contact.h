// Contacts as plain data: one per pair of convex parts (or part and ground), kept from step to step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "kernel/base/math.h"
#include "kernel/collision/gjk.h"

namespace rubble {

inline constexpr std::int32_t kGround = -1;  // stands for a body or a collider

// A part's contacts with a surface: the pair's second collider is none of the world's, but the number
// of the surface's body and of the slot in one. What is kGround or a collider is never below -1.
inline constexpr int kSurfaceSlots = 4;
inline std::int32_t surface_collider(std::int32_t body, int slot) {
  return -2 - (body * kSurfaceSlots + slot);
}
inline bool is_surface_collider(std::int32_t collider) { return collider <= -2; }
inline int surface_slot(std::int32_t collider) { return (-2 - collider) % kSurfaceSlots; }

struct ContactPoint {
  // What the solver asks: eight numbers in a row, as it reads them.
  Vec3f from_a, from_b;      // from the centres of mass, world orientation; unit: m
  float separation = 0;      // negative: overlap; unit: m
  float normal_impulse = 0;  // of the last substep; unit: N s

  Vec3f local_a, local_b;      // the same point in their own frames, to find it again
  float found_separation = 0;  // when a search last found the point, at local_a and local_b; unit: m
};

// A contact or a tie keeps its place in the solver's order while its height changes by no more than this,
// so that the order, and with it what the solver makes of it, is the same from step to step; unit: m.
inline constexpr float kOrderDistance = 0.1F;

// The two bodies of a pair: read for every pair in every step, so it is small and apart from the contact.
struct Pair {
  std::int32_t collider_a = 0, collider_b = 0;  // b may be kGround or a surface
  std::int32_t body_a = 0, body_b = 0;  // of the colliders; b may be kGround
  std::int32_t live = 0;  // 1: the contact had points in the last step
  double apart_until = 0;   // no points, and boxes apart, while the sum of the travels is less; unit: m
  double searched_until = 0;  // its points are only moved along while that sum is less; unit: m
  float order = 1e30F;    // height that decides its place in the solver's order; unit: m
};

// The points of a contact: in memory only where there are any, as four pairs in five of those that are
// near each other do not touch.
class ContactPoints {
 public:
  static constexpr int kMost = 6;  // four corners of a face and two of an end

  ContactPoints() = default;
  ContactPoints(const ContactPoints& other) {
    if (!other.made()) return;
    make();
    std::copy(other.begin(), other.end(), points_);
  }
  ContactPoints(ContactPoints&& other) noexcept : points_(std::exchange(other.points_, nullptr)) {}
  ContactPoints& operator=(ContactPoints other) noexcept {
    std::swap(points_, other.points_);
    return *this;
  }
  ~ContactPoints() { delete[] points_; }

  bool made() const { return points_ != nullptr; }
  void make() {
    if (!made()) points_ = new ContactPoint[kMost];
  }
  void drop() { delete[] std::exchange(points_, nullptr); }

  // As an array of kMost; none when not made.
  ContactPoint& operator[](int i) { return points_[i]; }
  const ContactPoint& operator[](int i) const { return points_[i]; }
  ContactPoint* begin() { return points_; }
  ContactPoint* end() { return points_ + (made() ? kMost : 0); }
  const ContactPoint* begin() const { return points_; }
  const ContactPoint* end() const { return points_ + (made() ? kMost : 0); }

 private:
  ContactPoint* points_ = nullptr;
};

struct Contact {
  static constexpr int kMaxPoints = ContactPoints::kMost;
  static constexpr float kUnlimited = 1e30F;  // of a contact, which presses as hard as it must; unit: N s

  std::int32_t body_a = 0, body_b = 0;  // b may be kGround
  int count = 0;                   // points in use
  bool has_normal = false;         // a search has found one before
  bool rolls_a = false, rolls_b = false;  // A, B is round and turns fast; of this step, see rolling.h
  Vec3f way_out;                   // what the parts of two overlapping pieces agreed on; zero: none
  // Each vector and its number in a row, as the solver reads them.
  Vec3f normal;                    // unit length, from A to B; of the last search
  float friction = 0;  // Coulomb coefficient of the pair; unit: 1
  Vec3f friction_impulse;          // tangential, of the last substep; unit: N s
  float twist_impulse = 0;         // about the normal, of the last substep; unit: N m s
  ContactPoints points;  // the first `count` are in use
  float pressed = 0;               // total normal impulse of the last step; unit: N s
  float rest_pressed = 0;          // the same when one of the two fell asleep
  // Of a tie, which is a contact that pulls: what it gives in a substep at most, and what it gave. unit: N s
  float most = kUnlimited, highest = 0;
  GjkCache cache;  // where the next search for the distance starts
};

}  // namespace rubble
