// Whether a world has come to rest.
#pragma once

#include "kernel/world/world.h"

namespace rubble {

// Longest verification of rest if no limit is given; unit: s.
inline constexpr double kLongestVerification = 1e6;

// While a pile grows, pieces fall asleep easily, and a sleeping piece supports any weight. Rest is a state of all pieces
// at once, so it is verified with all of them awake.
class World::Rest {
 public:
  // Every piece sleeps, or has a contact and is below both speeds; units: m/s, rad/s.
  bool reached(double speed, double angular_speed) const;
  // Wakes every piece. Motionless pieces far from moving ones may sleep until nothing moves. Then all are woken again.
  // Sleeping must be allowed. limit: time after which verification is given up; unit: s.
  void begin_verification(double limit = kLongestVerification);
  bool verifying() const;
  // True if, at one moment since begin_verification(), every piece was awake, below both speeds and in contact, and had
  // stayed within 0.3 mm for 0.5 s, within 1 mm for 1 s, or within 4 mm for 1 s without acceleration. So no piece that
  // slides or creeps faster than 4 mm/s passes. Rolling resistance (kernel/solver/speed_limits.h) is first switched
  // off, up to three times while there is time: pieces should rest without it.
  bool verified(double speed, double angular_speed) const;
  // Whether a piece sleeps, or has stayed in place as verified() requires.
  bool within_tolerance(int index) const;
  // All moving pieces fall asleep at their poses. Ends a verification.
  void put_all_to_sleep();

 private:
  friend class World;
  explicit Rest(Impl& world) : impl_(&world) {}

  Impl* impl_;
};

}  // namespace rubble
