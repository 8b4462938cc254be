#include "kernel/structure/standing.h"

#include <cstdio>

#include "kernel/base/error.h"
#include "kernel/structure/failure.h"

namespace rubble {

std::vector<SectionForces> check_stands(const Structure& structure, double gravity) {
  std::vector<SectionForces> forces(structure.bonds.size());
  const std::vector<BondStatus> status(structure.bonds.size());
  BondFailure worst;
  const auto fail = [&](const std::string& message, const std::string& found) {
    throw InputError(
        {"", 0, "pile.building", message, "a building that stands by itself", found,
         "make members larger, spans shorter or bars stronger; causes come afterwards"});
  };
  for (const BondGroup& group : find_groups(structure, status)) {
    if (!group.anchored) {
      fail("a part of the building hangs in the air",
           structure.members[structure.pieces[group.pieces[0]].member].name);
    }
    GroupStress stress(structure, group);
    const StressResult result = stress.solve(status, calc_weights(structure, gravity));
    for (std::size_t i = 0; i < group.bonds.size(); ++i) forces[group.bonds[i]] = result.forces[i];
    const BondFailure most = find_worst(structure, group, result, status);
    if (most.utilization > worst.utilization) worst = most;
  }
  if (worst.utilization > 1) {
    char times[32];
    std::snprintf(times, sizeof times, "%.2f", worst.utilization);
    fail("the building does not stand before its cause: a bond fails by " +
             std::string(failure_name(worst.mode)),
         describe_bond(structure, worst.bond) + ", loaded to " + times + " times its strength");
  }
  return forces;
}

}  // namespace rubble
