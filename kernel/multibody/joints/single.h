// Common code of hinge and slider: one coordinate x whose rate is the speed.
#pragma once

#include "kernel/multibody/joints/joint.h"

namespace rubble {

class SingleJoint : public Joint {
 public:
  void move(const double* displacement, double* q) const override { q[0] += displacement[0]; }
  void calc_rates(const double*, const double* u, double* rates) const override {
    rates[0] = u[0];
  }
  void add_spring(const TreeLink& link, const double* q, double* forces) const override;
  double calc_tangent_stiffness(const TreeLink& link, const double* q,
                                const double* u) const override;
  double calc_spring_energy(const TreeLink& link, const double* q) const override;
  void creep(TreeLink& link, const double* q) const override;
  int find_stops(const TreeLink& link, const double* q, double margin,
                 JointStop* stops) const override;
};

// Torques of springs count as at their yield from this share of it.
inline constexpr double kAtYield = 0.999;

}  // namespace rubble
