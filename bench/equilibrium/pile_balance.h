// A settled pile as a problem of balance: its pieces, where they touch, and what joints carry.
#pragma once

#include <vector>

#include "bench/equilibrium/balance.h"
#include "bench/equilibrium/contact_finder.h"
#include "bench/equilibrium/joint_reactions.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct PileBalance {
  BalanceProblem problem;
  std::vector<int> pieces;          // by body: which piece it is
  std::vector<TouchPoint> touches;  // by contact
};

// pile: what the state came from. Mass properties are those of the types (PieceType::volume, or the
// sum over the parts); the length of a body is the root mean square distance of its mass from its
// centre.
PileBalance make_pile_balance(const Pile& pile, const PileState& state, double gravity,
                              double tolerance = kContactTolerance);

}  // namespace rubble
