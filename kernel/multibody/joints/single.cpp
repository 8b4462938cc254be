#include "kernel/multibody/joints/single.h"

#include <algorithm>
#include <cmath>

namespace rubble {

void SingleJoint::add_spring(const TreeLink& link, const double* q, double* forces) const {
  if (link.stiffness > 0) forces[0] -= link.stiffness * (q[0] - link.rest);
}

double SingleJoint::calc_tangent_stiffness(const TreeLink& link, const double* q,
                                           const double* u) const {
  if (link.stiffness <= 0 || link.yield == kNever) return link.stiffness;
  const double x = q[0] - link.rest;
  const bool yields = std::abs(x) >= kAtYield * link.yield / link.stiffness && x * u[0] >= 0;
  return yields ? 0 : link.stiffness;
}

double SingleJoint::calc_spring_energy(const TreeLink& link, const double* q) const {
  const double x = q[0] - link.rest;
  return link.stiffness > 0 ? 0.5 * link.stiffness * x * x : 0;
}

void SingleJoint::creep(TreeLink& link, const double* q) const {
  if (link.stiffness <= 0 || link.yield == kNever) return;
  const double most = link.yield / link.stiffness;
  link.rest = std::min(q[0] + most, std::max(q[0] - most, link.rest));
}

int SingleJoint::find_stops(const TreeLink& link, const double* q, double margin,
                            JointStop* stops) const {
  int count = 0;
  if (q[0] - link.lower < margin) stops[count++] = {q[0] - link.lower, {1, 0, 0}};
  if (link.upper - q[0] < margin) stops[count++] = {link.upper - q[0], {-1, 0, 0}};
  return count;
}

}  // namespace rubble
