// From loads to stresses, and from those to bonds that fail.
#include <algorithm>
#include <chrono>

#include "kernel/settling/collapse_impl.h"

namespace rubble {
namespace {

// Bonds whose utilization is less than this share below that of the worst bond fail together with
// it. unit: 1
constexpr double kTogether = 0.3;
// Time in which forces redistribute before further bonds fail: a quarter of a floor's period. unit: s
constexpr double kRedistribution = 0.025;
// A beam that follows a sinking column turns on its seat, and lies there loose from this on: its mortar is crushed. Our
// choice. unit: rad
constexpr double kSeatRotation = 0.02;
// Time after which forces count as settled: a few periods of a floor. unit: s
constexpr double kCalmTime = 0.25;

}  // namespace

FailureOptions Collapse::Impl::failure_options(const BondGroup& group) const {
  FailureOptions f;
  f.together = kTogether;
  if (group.anchored && !settled.empty()) f.settled = &settled, f.overshoot = options.overshoot;
  if (!sinking.empty()) f.seat_rotation = kSeatRotation;
  return f;
}

StressResult Collapse::Impl::solve(Part& part, const std::vector<PieceLoad>& loads) {
  const auto start = std::chrono::steady_clock::now();
  StressResult result = part.stress->solve(status, loads);
  report.stress_seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ++report.solutions;
  return result;
}

double Collapse::Impl::breaking_energy(const std::vector<BondFailure>& failing) const {
  double sum = 0;
  for (const BondFailure& f : failing) sum += calc_breaking_energy(structure.bonds[f.bond].section);
  return sum;
}

// Whether an impact that would break these brings too little energy to do so; takes it otherwise.
bool Collapse::Impl::is_arrested(std::int32_t lead, Part& part, const Touches& touches,
                                 const std::vector<BondFailure>& failing) {
  double energy = 0;
  for (const auto& touch : touches) energy += touch.second.energy;
  if (!(energy > 0)) return false;
  const BondGroup& group = part.stress->group();
  const StressResult at_rest = solve(part, calc_loads(lead, part, touches, false));
  if (!find_failing(structure, group, at_rest, failure_options(group), status).empty())
    return false;
  const double taken = breaking_energy(failing);
  if (energy < taken) return ++arrests, true;
  for (const auto& touch : touches) {
    const Touch& t = touch.second;
    const double share = taken * t.energy / energy;
    if (group.anchored && t.other >= 0) drained.push_back({t.other, share});
    if (!group.anchored) drained.push_back({first + touch.first, share});
  }
  report.energy_taken += taken;
  return false;
}

// Whether the body came apart.
bool Collapse::Impl::update(std::int32_t lead, const Touches& touches) {
  Part& part = parts.at(lead);
  const BondGroup& group = part.stress->group();
  if (!group.anchored && (touches.empty() || !world.is_awake(first + lead))) return false;
  const bool impact =
      std::any_of(touches.begin(), touches.end(), [](const auto& t) { return t.second.impact; });
  if (part.waits > 0 && !impact) return false;
  const std::vector<PieceLoad> loads = calc_loads(lead, part, touches, true);
  if (!is_news(part, loads)) return false;
  StressResult result = solve(part, loads);
  while (lift(group, result)) result = solve(part, loads);
  part.solved.clear();
  for (const std::int32_t i : group.pieces) part.solved.push_back(loads[i]);
  part.forces = result.forces;
  const FailureOptions failure = failure_options(group);
  const std::vector<BondFailure> failing = find_failing(structure, group, result, failure, status);
  if (failing.empty() || is_arrested(lead, part, touches, failing)) return false;
  part.calm = 0;
  part.solved.clear();
  part.waits = int(kRedistribution / options.step);
  const int waits = part.waits;
  // One round: the next comes when contacts are solved again, or with the next step.
  bool broken = false;
  const std::vector<BondFailure> failed = fail_worst(structure, group, result, failure, status);
  for (const BondFailure& f : failed) {
    f.hinge ? ++report.hinges : ++report.broken;
    broken = broken || !f.hinge;
  }
  if (!broken) return false;
  tie(failed);
  const std::size_t before = parts.size();
  const std::vector<BondGroup> groups = groups_left_of(lead);
  const bool apart = groups.size() > 1 || groups[0].anchored != group.anchored;
  replace(lead, groups);
  for (const BondGroup& left : groups) {
    const auto at = parts.find(left.pieces[0]);
    if (at != parts.end() && at->second.solved.empty()) at->second.waits = waits;
  }
  return apart || parts.size() != before;
}

bool Collapse::Impl::on_solved() {
  const auto touches = find_touches();
  std::vector<std::int32_t> leads;
  for (const auto& part : parts) leads.push_back(part.first);
  bool apart = false;
  for (const std::int32_t lead : leads) {
    const auto found = touches.find(lead);
    apart = update(lead, found == touches.end() ? Touches{} : found->second) || apart;
  }
  return apart;
}

void Collapse::Impl::settle_forces() {
  const int long_enough = int(kCalmTime / options.step);
  breaking = false;
  for (auto& [lead, part] : parts) {
    if (part.waits > 0) --part.waits, breaking = true;
    const BondGroup& group = part.stress->group();
    if (++part.calm != long_enough || settled.empty()) continue;
    if (part.forces.size() != group.bonds.size()) continue;
    for (std::size_t i = 0; i < group.bonds.size(); ++i) settled[group.bonds[i]] = part.forces[i];
  }
}

}  // namespace rubble
