// A seeded earthquake: the acceleration of the ground in one horizontal direction.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/building.h"

namespace rubble {

// The cause's accelerogram, read between its samples by straight lines. Without one: twenty sines about
// the cause's frequency under the envelope of Jennings, Housner and Tsai (1968), which rises with the
// square of time, stays, and fades. Scaled so that its largest value is the cause's.
class GroundMotion {
 public:
  // step: of the samples; unit: s.
  GroundMotion(const CollapseCause& cause, std::uint64_t seed, double step);
  // Of the n-th step; 0 after the end. unit: m/s2
  Vec3 at(std::int64_t step) const;
  bool over(std::int64_t step) const { return step >= std::int64_t(samples_.size()); }

 private:
  void draw(const CollapseCause& cause, std::uint64_t seed, double step);
  void read(const CollapseCause& cause, double step);

  std::vector<double> samples_;
  Vec3 direction_;
};

}  // namespace rubble
