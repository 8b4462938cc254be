// From stresses to what fails: bonds that break and hinges that form, until the rest carries the loads.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/model/pile_state.h"
#include "kernel/structure/stress.h"
#include "kernel/structure/structure.h"

namespace rubble {

struct FailureOptions {
  // In one round all bonds fail that are used up as much as the worst one, to this share; range: 0 to 1.
  double together = 0.1;
  int rounds = 1000;  // at most; >= 1
  // A sudden change overshoots by this share of it: bonds must carry f + overshoot (f - settled).
  double overshoot = 0;                        // unit: 1; range: 0 to 1
  const std::vector<SectionForces>* settled = nullptr;  // before the change, by bond; null: none
  double seat_rotation = 0;  // by which a bond without bars comes off its seat; 0: never; unit: rad
  bool hinges = true;  // bars keep a bent section as a hinge until they tear; false: it breaks at once
};

struct BondFailure {
  std::int32_t bond = 0;                 // index into Structure::bonds; -1: none
  FailureMode mode = FailureMode::none;  // which strength was used up
  bool hinge = false;                    // it goes on as one
  double utilization = 0;                // when it failed; unit: 1
  bool torn = false;                     // bars of its hinge, or off its seat
};

// One round: of those that are used up the worst, and all that are nearly as bad, fail. Writes `status`.
std::vector<BondFailure> fail_worst(const Structure& structure, const BondGroup& group,
                                    const StressResult& result, const FailureOptions& options,
                                    std::vector<BondStatus>& status);

// Solves a group, lets fail what is used up most, and solves again, until all holds, the group has
// come apart or the rounds are over. Writes `status`.
std::vector<BondFailure> let_fail(const Structure& structure, GroupStress& stress,
                                  const std::vector<PieceLoad>& loads, const FailureOptions& options,
                                  std::vector<BondStatus>& status);

// The bond of a group that is used up most. bond: -1 when there is none.
BondFailure find_worst(const Structure& structure, const BondGroup& group, const StressResult& result,
                       const std::vector<BondStatus>& status);

// All that are used up, in the order of the group's bonds.
std::vector<BondFailure> find_failing(const Structure& structure, const BondGroup& group,
                                      const StressResult& result, const FailureOptions& options,
                                      const std::vector<BondStatus>& status);

// What breaking a bond takes: the concrete's fracture energy and the bars' plastic work. unit: J
double calc_breaking_energy(const Section& section);

// Whether a structure stands by itself.
// The forces in a structure's bonds under its own weight, by bond. Bonds may crack, or bend as hinges, where the others
// carry their loads and no piece comes loose. Else throws InputError naming the bond that is used up most, its failure and by
// how much: the building does not stand by itself.
std::vector<SectionForces> check_stands(const Structure& structure, double gravity);

// The bars of a bond after its concrete has failed, as ties between its pieces.
// One tie, or two side by side where the section is wide, so that what hangs on it turns like a hinge.
// Pieces have their numbers in the structure; b is -1 for the foundation. continuity: share of the bars
// that hold; range: 0 to 1. None where the section has no bars.
std::vector<TieState> find_remaining_bars(const Structure& structure, const Bond& bond, double continuity);

}  // namespace rubble
