// The linear program of one island, solved by COIN-OR's Clp with columns made as they are needed.
#pragma once

#include <memory>

#include "bench/equilibrium/balance.h"

namespace rubble {

struct IslandForces {
  std::vector<Vec3> contact_force;      // on b, by contact; unit: N
  std::vector<double> reaction_factor;  // by reaction
  bool optimal = false;
};

// All bodies of `island` are taken to be one problem.
IslandForces solve_island(const BalanceProblem& island);

}  // namespace rubble
