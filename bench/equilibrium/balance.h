// Can forces at given contacts and joints hold rigid bodies at rest under gravity? A linear
// program.
//
//   minimise    sum over the bodies i of |f_i|_1 / w_i + |t_i|_1 / (w_i k_i)
//   subject to  f_i = load + sum of the forces on i,   t_i = their torque about its centre of mass,
//               each contact force in its Coulomb cone: n + mu t with every tangent |t| <= 1, times
//               a factor >= 0; joint forces and torques within what the joint carries.
//
// w is the weight and k the radius of gyration of a body: what is left over, f and t, is its
// imbalance. 0 for all means: these forces exist, the pile can rest as it is (for rigid bodies any
// such forces are admissible). The cones are not cut into facets beforehand: each starts with four
// directions, and wherever the duals show that another direction of the round cone would help, that
// very direction is added and the program is solved on, until none helps.
#pragma once

#include <limits>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct BalanceBody {
  Vec3 centre;         // of mass; unit: m
  double weight = 0;   // unit: N; > 0
  double length = 0;   // the radius of gyration, see make_balance_body(); unit: m; > 0
  Vec3 force, torque;  // what acts on it besides contacts and joints, gravity too; unit: N, N m
};

inline constexpr int kImmovable = -1;

struct BalanceContact {
  int a = kImmovable, b = kImmovable;  // bodies
  Vec3 point;                          // unit: m
  Vec3 normal;                         // from a to b, unit length
  double friction = 0;                 // Coulomb coefficient
};

// One force or torque of a joint on b, and its reaction on a: a multiple of a direction.
struct BalanceReaction {
  int a = kImmovable, b = kImmovable;
  Vec3 force;              // on b at `point`; zero: none
  Vec3 torque;             // on b
  Vec3 point;              // unit: m
  bool one_sided = false;  // multiples >= 0 only, as of a stop
  double limit = std::numeric_limits<double>::infinity();  // of the multiple, either way; >= 0
};

struct BalanceProblem {
  std::vector<BalanceBody> bodies;
  std::vector<BalanceContact> contacts;
  std::vector<BalanceReaction> reactions;
};

struct BalanceResult {
  std::vector<Vec3> force, torque;    // left over, by body; unit: N, N m
  std::vector<Vec3> contact_force;    // on b, by contact; unit: N
  std::vector<double> residual;       // by body: max(|force| / weight, |torque| / (weight length))
  int largest_island = 0;             // bodies that hang together by contacts and joints
  bool optimal = true;                // false: a limit came first, so less may be left over

  double mean_residual() const;               // 0 for no body
  int count_above(double share) const;        // bodies whose residual is larger
};

// Solves island by island. The result is checked: what is left over is summed up anew from forces
// that are within their cones, so it is an upper bound whatever the solver did.
BalanceResult solve_balance(const BalanceProblem& problem);

}  // namespace rubble
