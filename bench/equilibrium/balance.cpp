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
    for (int* parent = &parent_[std::size_t(i)]; *parent != i; parent = &parent_[std::size_t(i)])
      i = *parent = parent_[std::size_t(*parent)];
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

class Splitter {
 public:
  explicit Splitter(const BalanceProblem& problem)
      : island_of_(problem.bodies.size()), number_(problem.bodies.size()) {
    Islands islands(problem.bodies.size());
    for (const BalanceContact& c : problem.contacts) islands.join(c.a, c.b);
    for (const BalanceReaction& r : problem.reactions) islands.join(r.a, r.b);
    for (std::size_t i = 0; i < problem.bodies.size(); ++i)
      add_body(i, islands.root(int(i)), problem.bodies[i]);
    for (std::size_t i = 0; i < problem.contacts.size(); ++i)
      add(i, problem.contacts[i], &Island::contacts, &BalanceProblem::contacts);
    for (std::size_t i = 0; i < problem.reactions.size(); ++i)
      add(i, problem.reactions[i], &Island::reactions, &BalanceProblem::reactions);
  }

  const std::vector<Island>& islands() const { return parts_; }

 private:
  // The root is the smallest of its island, so it comes first.
  void add_body(std::size_t i, int root, const BalanceBody& body) {
    if (root == int(i)) {
      island_of_[i] = int(parts_.size());
      parts_.emplace_back();
    }
    island_of_[i] = island_of_[std::size_t(root)];
    BalanceProblem& part = parts_[std::size_t(island_of_[i])].problem;
    number_[i] = int(part.bodies.size());
    part.bodies.push_back(body);
  }

  // A contact or a reaction, with the bodies' numbers in their island.
  template <typename Link>
  void add(std::size_t index, Link link, std::vector<std::size_t> Island::* indices,
           std::vector<Link> BalanceProblem::* links) {
    const int body = link.a == kImmovable ? link.b : link.a;
    if (body == kImmovable) return;
    Island& part = parts_[std::size_t(island_of_[std::size_t(body)])];
    for (int* i : {&link.a, &link.b})
      if (*i != kImmovable) *i = number_[std::size_t(*i)];
    (part.problem.*links).push_back(link);
    (part.*indices).push_back(index);
  }

  std::vector<Island> parts_;
  std::vector<int> island_of_, number_;  // by body
};

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
}

double residual_of(const BalanceBody& body, const Vec3& force, const Vec3& torque) {
  return std::max(norm(force) / body.weight, norm(torque) / (body.weight * body.length));
}

}  // namespace

BalanceResult solve_balance(const BalanceProblem& problem) {
  BalanceResult result;
  result.contact_force.resize(problem.contacts.size());
  std::vector<double> factors(problem.reactions.size());
  const Splitter splitter(problem);
  for (const Island& part : splitter.islands()) {
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
  for (std::size_t i = 0; i < problem.bodies.size(); ++i)
    result.residual.push_back(
        residual_of(problem.bodies[i], result.force[i], result.torque[i]));
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
