#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "bench/equilibrium/pile_balance.h"
#include "bench/equilibrium/pile_record.h"

namespace rubble {
namespace {

constexpr std::size_t kMostNamed = 5;  // of the pieces farthest off balance

double in_percent(double share) { return std::round(share * 1e8) / 1e6; }

// Of all pieces together, by their weight.
double weighed_residual(const BalanceProblem& problem, const BalanceResult& result) {
  double left = 0, weight = 0;
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    left += result.residual[i] * problem.bodies[i].weight;
    weight += problem.bodies[i].weight;
  }
  return weight > 0 ? left / weight : 0;
}

// What a piece touches, each with how far it is away in mm: overlap is negative.
Record name_neighbours(const PileBalance& balance, int piece, const PileState& state) {
  Record neighbours = Record::array();
  std::map<int, double> gaps;
  for (const TouchPoint& touch : balance.touches) {
    if (touch.a != piece && touch.b != piece) continue;
    const int other = touch.a == piece ? touch.b : touch.a;
    const auto known = gaps.emplace(other, touch.gap).first;
    known->second = std::min(known->second, touch.gap);
  }
  for (const auto& [other, gap] : gaps)
    neighbours.push_back({other == kGroundPiece ? "ground" : name_of_piece(state, other),
                          std::round(gap * 1e5) / 1e2});
  return neighbours;
}

Record name_worst(const PileBalance& balance, const BalanceResult& result, const PileState& state) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < result.residual.size(); ++i)
    if (result.residual[i] > 0.01) order.push_back(i);
  std::sort(order.begin(), order.end(), [&result](std::size_t i, std::size_t j) {
    return result.residual[i] > result.residual[j];
  });
  if (order.size() > kMostNamed) order.resize(kMostNamed);
  Record worst = Record::array();
  for (std::size_t i : order)
    worst.push_back({{"piece", name_of_piece(state, balance.pieces[i])},
                     {"percent", in_percent(result.residual[i])},
                     {"touches", name_neighbours(balance, balance.pieces[i], state)}});
  return worst;
}

}  // namespace

void add_surface_depth(const Pile& pile, const PileState& state, Record& record) {
  const SurfaceDepth deepest = find_surface_depth(pile.types, state);
  if (deepest.piece < 0) return;
  record["terrain_max_mm"] = std::round(deepest.depth * 1e6) / 1e3;
  record["deepest_in_terrain"] = name_of_piece(state, deepest.piece);
}

void add_balance(const Work& work, const PileState& state, double tolerance, Record& record) {
  const auto begin = std::chrono::steady_clock::now();
  const PileBalance balance =
      make_pile_balance(work.pile, state, work.settle.gravity, tolerance);
  const auto found = std::chrono::steady_clock::now();
  const BalanceResult result = solve_balance(balance.problem);
  const auto end = std::chrono::steady_clock::now();
  const auto seconds = [](auto span) {
    return std::round(std::chrono::duration<double>(span).count() * 1e3) / 1e3;
  };
  record["tolerance_mm"] = tolerance * 1e3;
  record["bodies"] = balance.problem.bodies.size();
  record["contact_points"] = balance.problem.contacts.size();
  record["largest_island"] = result.largest_island;
  record["residual_percent"] = in_percent(weighed_residual(balance.problem, result));
  record["residual_mean_percent"] = in_percent(result.mean_residual());
  record["off_1_percent"] = result.count_above(0.01);
  record["off_10_percent"] = result.count_above(0.10);
  record["off_50_percent"] = result.count_above(0.50);
  record["off_balance"] = name_worst(balance, result, state);
  record["optimal"] = result.optimal;
  record["contacts_s"] = seconds(found - begin);
  record["program_s"] = seconds(end - found);
}

}  // namespace rubble
