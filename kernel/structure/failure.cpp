#include "kernel/structure/failure.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kFractureEnergy = 130;  // of concrete of 33 MPa: 73 fcm^0.18, fib Model Code 2010; unit: J/m2

SectionForces overshoot(const SectionForces& f, const SectionForces& s, double share) {
  const auto peak = [share](double now, double before) { return now + share * (now - before); };
  return {peak(f.axial, s.axial),   peak(f.shear_s, s.shear_s),   peak(f.shear_t, s.shear_t),
          peak(f.torque, s.torque), peak(f.moment_s, s.moment_s), peak(f.moment_t, s.moment_t)};
}

// A hinge's moment about its axis is what its bars carry: the section is asked for the rest.
Utilization use_of(const Bond& bond, const BondStatus& status, SectionForces forces) {
  if (status.hinge_s) forces.moment_s = 0;
  if (status.hinge_t) forces.moment_t = 0;
  if (status.hinge_n) forces.torque = 0;
  return calc_utilization(bond.section, forces);
}

double turned_beyond_yield(double rotation, double moment, double stiffness) {
  return std::abs(rotation - moment / stiffness);
}

// 1 when the bars of a hinge tear.
double use_of_rotation(const Bond& bond, const BondStatus& status, const StressResult& result, std::size_t i) {
  double most = 0;
  const auto turn = [&most](bool hinge, double rotation, double moment, double stiffness) {
    if (hinge) most = std::max(most, turned_beyond_yield(rotation, moment, stiffness));
  };
  turn(status.hinge_s, result.rotation_s[i], status.moment_s, bond.bending_s_stiffness);
  turn(status.hinge_t, result.rotation_t[i], status.moment_t, bond.bending_t_stiffness);
  turn(status.hinge_n, result.rotation_n[i], status.torque, bond.torsion_stiffness);
  return most > 0 ? most / bond.section.steel.rupture_rotation : 0;
}

std::vector<BondFailure> rate(const Structure& structure, const BondGroup& group,
                              const StressResult& result, const FailureOptions& options,
                              const std::vector<BondStatus>& status) {
  std::vector<BondFailure> rated;
  for (std::size_t i = 0; i < group.bonds.size(); ++i) {
    const std::int32_t index = group.bonds[i];
    const Bond& bond = structure.bonds[index];
    const BondStatus& state = status[index];
    if (state.broken) continue;
    SectionForces forces = result.forces[i];
    if (options.settled) forces = overshoot(forces, (*options.settled)[index], options.overshoot);
    const Utilization use = use_of(bond, state, forces);
    const double torn = use_of_rotation(bond, state, result, i);
    if (torn > use.value) {
      rated.push_back({index, FailureMode::bending, false, torn, true});
    } else {
      rated.push_back({index, use.mode, false, use.value, false});
    }
  }
  return rated;
}

// Bars that yield leave a hinge about the axis that is used up more: one in bending, one in torsion.
bool make_hinge(const Bond& bond, FailureMode mode, const SectionForces& forces, BondStatus& status) {
  if (mode == FailureMode::torsion) {
    if (status.hinge_n) return false;
    status.hinge_n = true;
    status.torque = std::copysign(std::min(calc_yield_torque(bond.section), std::abs(forces.torque)), forces.torque);
    return true;
  }
  if (mode != FailureMode::bending || status.hinge_s || status.hinge_t) return false;
  const double of_s = calc_yield_moment(bond.section, forces.axial, true);
  const double of_t = calc_yield_moment(bond.section, forces.axial, false);
  const double use_s = of_s > 0 ? std::abs(forces.moment_s) / of_s : 0;
  const double use_t = of_t > 0 ? std::abs(forces.moment_t) / of_t : 0;
  if (!(use_s > 0 || use_t > 0)) return false;
  if (use_s >= use_t) {
    status.hinge_s = true;
    status.moment_s = std::copysign(std::min(of_s, std::abs(forces.moment_s)), forces.moment_s);
  } else {
    status.hinge_t = true;
    status.moment_t = std::copysign(std::min(of_t, std::abs(forces.moment_t)), forces.moment_t);
  }
  return true;
}

}  // namespace

BondFailure find_worst(const Structure& structure, const BondGroup& group, const StressResult& result,
                       const std::vector<BondStatus>& status) {
  BondFailure worst;
  worst.bond = -1;
  for (const BondFailure& rated : rate(structure, group, result, {}, status)) {
    if (worst.bond < 0 || rated.utilization > worst.utilization) worst = rated;
  }
  return worst;
}

std::vector<BondFailure> find_failing(const Structure& structure, const BondGroup& group,
                                      const StressResult& result, const FailureOptions& options,
                                      const std::vector<BondStatus>& status) {
  std::vector<BondFailure> failing = rate(structure, group, result, options, status);
  failing.erase(std::remove_if(failing.begin(), failing.end(),
                               [](const BondFailure& f) { return !(f.utilization > 1); }),
                failing.end());
  return failing;
}

double calc_breaking_energy(const Section& s) {
  const double bars = std::max(calc_yield_moment(s, 0, true), calc_yield_moment(s, 0, false));
  return kFractureEnergy * s.area + bars * s.steel.rupture_rotation;
}

std::vector<BondFailure> fail_worst(const Structure& structure, const BondGroup& group,
                                    const StressResult& result, const FailureOptions& options,
                                    std::vector<BondStatus>& status) {
  std::vector<BondFailure> failures = find_failing(structure, group, result, options, status);
  double most = 0;
  for (const BondFailure& f : failures) most = std::max(most, f.utilization);
  const double limit = most * (1 - options.together);
  failures.erase(std::remove_if(failures.begin(), failures.end(),
                                [limit](const BondFailure& f) { return f.utilization < limit; }),
                 failures.end());
  for (BondFailure& f : failures) {
    const Bond& bond = structure.bonds[f.bond];
    BondStatus& state = status[f.bond];
    const auto at = std::lower_bound(group.bonds.begin(), group.bonds.end(), f.bond);
    f.hinge = options.hinges && !f.torn && bond.section.steel.area > 0 &&
              make_hinge(bond, f.mode, result.forces[std::size_t(at - group.bonds.begin())], state);
    state.broken = !f.hinge;
  }
  return failures;
}

std::vector<BondFailure> let_fail(const Structure& structure, GroupStress& stress,
                                  const std::vector<PieceLoad>& loads, const FailureOptions& options,
                                  std::vector<BondStatus>& status) {
  std::vector<BondFailure> all;
  const BondGroup& group = stress.group();
  std::vector<std::uint8_t> others(structure.pieces.size(), 1);
  for (const std::int32_t piece : group.pieces) others[piece] = 0;
  for (int round = 0; round < options.rounds; ++round) {
    const StressResult result = stress.solve(status, loads);
    if (!result.stable) break;
    const std::vector<BondFailure> failures = fail_worst(structure, group, result, options, status);
    if (failures.empty()) break;
    all.insert(all.end(), failures.begin(), failures.end());
    // What has come apart is no longer one problem.
    const std::vector<BondGroup> left = find_groups(structure, status, others);
    if (left.size() > 1 || left[0].anchored != group.anchored) break;
  }
  return all;
}

}  // namespace rubble
