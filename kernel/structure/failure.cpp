#include "kernel/structure/failure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernel/base/error.h"

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

double use_of_seat(const StressResult& result, std::size_t i, double seat_rotation) {
  if (!(seat_rotation > 0)) return 0;
  return std::max(std::abs(result.rotation_s[i]), std::abs(result.rotation_t[i])) / seat_rotation;
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
    const double torn = bond.section.steel.area > 0 ? use_of_rotation(bond, state, result, i)
                                                    : use_of_seat(result, i, options.seat_rotation);
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
  for (int round = 0; round < options.rounds; ++round) {
    const StressResult result = stress.solve(status, loads);
    if (!result.stable) break;
    const std::vector<BondFailure> failures = fail_worst(structure, group, result, options, status);
    if (failures.empty()) break;
    all.insert(all.end(), failures.begin(), failures.end());
    // What has come apart is no longer one problem.
    const std::vector<BondGroup> left = find_parts(structure, status, group);
    if (left.size() > 1 || left[0].anchored != group.anchored) break;
  }
  return all;
}

namespace {

[[noreturn]] void refuse_building(const std::string& message, const std::string& found) {
  throw InputError({"", 0, "pile.building", message, "a building that stands by itself", found,
                    "make members larger, spans shorter or bars stronger; causes come afterwards"});
}

// Under its own weight. Bonds of small pieces may crack or bend as hinges, as long as all hangs together and the rest
// carries it. Empty: it comes down.
StressResult find_standing(const Structure& structure, GroupStress& stress, std::vector<BondStatus> status,
                           const std::vector<PieceLoad>& weights) {
  const BondGroup& group = stress.group();
  let_fail(structure, stress, weights, {}, status);
  const std::vector<BondGroup> left = find_parts(structure, status, group);
  if (left.size() != 1 || !left[0].anchored) return {};
  StressResult result = stress.solve(status, weights);
  if (!result.stable || find_worst(structure, group, result, status).utilization > 1) return {};
  return result;
}

}  // namespace

std::vector<SectionForces> check_stands(const Structure& structure, double gravity) {
  std::vector<SectionForces> forces(structure.bonds.size());
  const std::vector<BondStatus> status(structure.bonds.size());
  const std::vector<PieceLoad> weights = calc_weights(structure, gravity);
  for (const BondGroup& group : find_groups(structure, status)) {
    if (!group.anchored)
      refuse_building("a part of the building hangs in the air", structure.members[structure.pieces[group.pieces[0]].member].name);
    GroupStress stress(structure, group);
    StressResult result = stress.solve(status, weights);
    const BondFailure worst = find_worst(structure, group, result, status);
    if (worst.utilization > 1) result = find_standing(structure, stress, status, weights);
    if (result.forces.empty()) {
      char times[32];
      std::snprintf(times, sizeof times, "%.2f", worst.utilization);
      refuse_building("the building does not stand before its cause: a bond fails by " + std::string(failure_name(worst.mode)),
                      describe_bond(structure, worst.bond) + ", loaded to " + times + " times its strength");
    }
    for (std::size_t i = 0; i < group.bonds.size(); ++i) forces[group.bonds[i]] = result.forces[i];
  }
  return forces;
}

namespace {

constexpr double kEmbedded = 0.15;  // from the section to where a bar is held in a piece; unit: m
constexpr double kWide = 2;         // sections this many times as wide as deep have two ties; unit: 1
// Concrete that spalls frees the bars: they bear again after the pieces have parted by this share of the
// section's depth, or turned by about 0.4 rad. Catenary action of floors begins no earlier. unit: 1
constexpr double kFreed = 0.2;
// Bars yield over some 12 diameters on either side of a crack and reach 7.5 % there: class C of EN
// 1992-1-1, annex C. unit: m
constexpr double kRuptureStretch = 0.075 * 0.4;
// Plastic moment of round bars against their force: fy d^3 / 6 against fy pi d^2 / 4, for d of 14 mm. unit: m
constexpr double kBarLever = 0.014 * 2 / (3 * 3.14159265358979);

// Between a piece's middle and its surface, however small it is.
double embedment(const Structure& structure, std::int32_t piece, const Section& s) {
  if (piece == kFoundation) return kEmbedded;
  const double to_middle = std::abs(dot(structure.pieces[piece].centre - s.centroid, s.normal));
  return std::min(kEmbedded, 0.5 * to_middle);
}

}  // namespace

std::vector<TieState> find_remaining_bars(const Structure& structure, const Bond& bond, double continuity) {
  const Section& s = bond.section;
  const double strength = continuity * s.steel.area * s.steel.yield;
  if (!(strength > 0)) return {};
  const double depth = 2 * std::min(s.half_s, s.half_t), width = 2 * std::max(s.half_s, s.half_t);
  const Vec3 across = s.half_s > s.half_t ? s.axis_s : s.axis_t;
  const double in_a = embedment(structure, bond.piece_a, s), in_b = embedment(structure, bond.piece_b, s);
  TieState tie;
  tie.piece_a = bond.piece_a, tie.piece_b = bond.piece_b;
  tie.length = in_a + in_b + kFreed * depth;
  tie.stretch = kRuptureStretch;
  const bool two = width > kWide * depth;
  tie.strength = strength / (two ? 2 : 1);
  tie.bending = tie.strength * kBarLever;
  std::vector<TieState> ties;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 place = s.centroid + across * (two ? side * width / 4 : 0);
    const Vec3 a = place - s.normal * in_a, b = place + s.normal * in_b;
    tie.anchor_a = a - structure.pieces[bond.piece_a].position;
    tie.anchor_b = bond.piece_b == kFoundation ? b : b - structure.pieces[bond.piece_b].position;
    ties.push_back(tie);
    if (!two) break;
  }
  return ties;
}

}  // namespace rubble
