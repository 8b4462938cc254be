#include "bench/equilibrium/balance.h"

#include <algorithm>
#include <numeric>

#include "bench/equilibrium/balance_program.h"

namespace rubble {
namespace {

// Bodies that hang together, by the smallest of their numbers.
class Islands {
 public:
  explicit Islands(std::size_t bodies) : parent_(bodies) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int i) {
    while (parent_[std::size_t(i)] != i) i = parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
    return i;
  }
  void join(int a, int b) {
    if (a == kImmovable || b == kImmovable) return;
    a = root(a), b = root(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

// A part of the problem, and which contacts and reactions of the whole its own are.
struct Island {
  BalanceProblem problem;
  std::vector<std::size_t> contacts, reactions;
};

std::vector<Island> split(const BalanceProblem& problem) {
  Islands islands(problem.bodies.size());
  for (const BalanceContact& c : problem.contacts) islands.join(c.a, c.b);
  for (const BalanceReaction& r : problem.reactions) islands.join(r.a, r.b);
  std::vector<int> island_of(problem.bodies.size()), number(problem.bodies.size());
  std::vector<Island> parts;
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const int root = islands.root(int(i));
    if (root == int(i)) island_of[i] = int(parts.size()), parts.emplace_back();
    island_of[i] = island_of[std::size_t(root)];
    BalanceProblem& part = parts[std::size_t(island_of[i])].problem;
    number[i] = int(part.bodies.size());
    part.bodies.push_back(problem.bodies[i]);
  }
  const auto renumber = [&](int i) { return i == kImmovable ? kImmovable : number[std::size_t(i)]; };
  const auto part_of = [&](int a, int b) -> Island& {
    return parts[std::size_t(island_of[std::size_t(a == kImmovable ? b : a)])];
  };
  for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
    BalanceContact c = problem.contacts[i];
    if (c.a == kImmovable && c.b == kImmovable) continue;
    Island& part = part_of(c.a, c.b);
    c.a = renumber(c.a), c.b = renumber(c.b);
    part.problem.contacts.push_back(c);
    part.contacts.push_back(i);
  }
  for (std::size_t i = 0; i < problem.reactions.size(); ++i) {
    BalanceReaction r = problem.reactions[i];
    if (r.a == kImmovable && r.b == kImmovable) continue;
    Island& part = part_of(r.a, r.b);
    r.a = renumber(r.a), r.b = renumber(r.b);
    part.problem.reactions.push_back(r);
    part.reactions.push_back(i);
  }
  return parts;
}

void apply(const BalanceProblem& problem, BalanceResult& result, int i, const Vec3& force,
           const Vec3& torque, const Vec3& point) {
  if (i == kImmovable) return;
  const Vec3 arm = point - problem.bodies[std::size_t(i)].centre;
  result.force[std::size_t(i)] += force;
  result.torque[std::size_t(i)] += torque + cross(arm, force);
}

// What is left over, from the forces alone.
void sum_up(const BalanceProblem& problem, const std::vector<double>& factors,
            BalanceResult& result) {
  for (const BalanceBody& body : problem.bodies) {
    result.force.push_back(body.force);
    result.torque.push_back(body.torque);
  }
  for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
    const BalanceContact& c = problem.contacts[i];
    apply(problem, result, c.b, result.contact_force[i], {}, c.point);
    apply(problem, result, c.a, -result.contact_force[i], {}, c.point);
  }
  for (std::size_t i = 0; i < problem.reactions.size(); ++i) {
    const BalanceReaction& r = problem.reactions[i];
    apply(problem, result, r.b, r.force * factors[i], r.torque * factors[i], r.point);
    apply(problem, result, r.a, r.force * -factors[i], r.torque * -factors[i], r.point);
  }
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const BalanceBody& body = problem.bodies[i];
    result.residual.push_back(std::max(norm(result.force[i]) / body.weight,
                                       norm(result.torque[i]) / (body.weight * body.length)));
  }
}

}  // namespace

BalanceResult solve_balance(const BalanceProblem& problem) {
  BalanceResult result;
  result.contact_force.resize(problem.contacts.size());
  std::vector<double> factors(problem.reactions.size());
  for (const Island& part : split(problem)) {
    result.largest_island = std::max(result.largest_island, int(part.problem.bodies.size()));
    if (part.contacts.empty() && part.reactions.empty()) continue;  // it hangs in the air
    const IslandForces forces = solve_island(part.problem);
    result.optimal = result.optimal && forces.optimal;
    for (std::size_t i = 0; i < part.contacts.size(); ++i)
      result.contact_force[part.contacts[i]] = forces.contact_force[i];
    for (std::size_t i = 0; i < part.reactions.size(); ++i)
      factors[part.reactions[i]] = forces.reaction_factor[i];
  }
  sum_up(problem, factors, result);
  return result;
}

double BalanceResult::mean_residual() const {
  const double sum = std::accumulate(residual.begin(), residual.end(), 0.0);
  return residual.empty() ? 0 : sum / double(residual.size());
}

int BalanceResult::count_above(double share) const {
  return int(std::count_if(residual.begin(), residual.end(),
                           [share](double r) { return r > share; }));
}

}  // namespace rubble
