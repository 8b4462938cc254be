#include "bench/equilibrium/balance_program.h"

#include <ClpSimplex.hpp>
#include <ClpSolve.hpp>
#include <CoinPackedMatrix.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr int kRows = 6;            // of a body: force along x, y, z, torque about x, y, z
constexpr int kFirstDirections = 4;  // of each friction cone
// A direction is added when it would lower the sum of residuals by more than this for each newton
// that equals the lighter body's weight.
constexpr double kGain = 1e-6;
// A round of new directions that lowers the sum of residuals by less than this is the last: each
// gains about a third of the one before.
constexpr double kEnough = 1e-5;
constexpr double kNothing = 1e-14;    // a smaller element is 0
constexpr int kMostRounds = 40;
constexpr double kMostSeconds = 600;  // of an island

struct Wrench {
  Vec3 force, torque;
};

// Of a variable.
struct Range {
  double least = 0, most = std::numeric_limits<double>::infinity();
};

// Columns on their way to Clp.
struct Columns {
  std::vector<CoinBigIndex> starts{0};
  std::vector<int> rows;
  std::vector<double> elements, lower, upper, costs;

  int count() const { return int(lower.size()); }

  void add(int size, const int* r, const double* e, const Range& range, double cost) {
    for (int i = 0; i < size; ++i) {
      if (std::abs(e[i]) < kNothing) continue;
      rows.push_back(r[i]);
      elements.push_back(e[i]);
    }
    starts.push_back(CoinBigIndex(rows.size()));
    lower.push_back(std::max(range.least, -COIN_DBL_MAX));
    upper.push_back(std::min(range.most, COIN_DBL_MAX));
    costs.push_back(cost);
  }
};

class Program {
 public:
  explicit Program(const BalanceProblem& island) : island_(island) {
    clp_.setLogLevel(0);
    clp_.setMaximumSeconds(kMostSeconds);
    add_rows();
    add_slacks();
    for (const BalanceReaction& reaction : island_.reactions) add_reaction(reaction);
    for (std::size_t c = 0; c < island_.contacts.size(); ++c) add_first_directions(int(c));
    load();
  }

  IslandForces solve() {
    ClpSolve how;
    how.setSolveType(ClpSolve::useBarrier);  // three times faster than the simplex method here
    clp_.initialSolve(how);
    IslandForces forces;
    double before = 1e300;  // the sum of residuals
    for (int round = 0; round < kMostRounds && clp_.status() == 0; ++round) {
      forces.optimal = before - clp_.objectiveValue() < kEnough || !price();
      if (forces.optimal) break;
      before = clp_.objectiveValue();
      clp_.primal(1);
    }
    read(forces);
    return forces;
  }

 private:
  struct Column {
    int contact = 0;
    Vec3 direction;   // of the force on b
    double unit = 1;  // newtons of one of the variable
  };

  static double unit_of(const BalanceProblem& p, int a, int b) {
    double unit = 1e300;
    for (int i : {a, b})
      if (i != kImmovable) unit = std::min(unit, p.bodies[std::size_t(i)].weight);
    return unit;
  }

  // f, t left over = loads + columns; slacks take them: columns + plus - minus = -loads.
  void add_rows() {
    const int rows = kRows * int(island_.bodies.size());
    row_values_.resize(std::size_t(rows));
    for (std::size_t i = 0; i < island_.bodies.size(); ++i) {
      const BalanceBody& body = island_.bodies[i];
      for (int k = 0; k < 3; ++k) {
        row_values_[kRows * i + std::size_t(k)] = -body.force[k] / body.weight;
        row_values_[kRows * i + 3 + std::size_t(k)] = -body.torque[k] / (body.weight * body.length);
      }
    }
  }

  void add_slacks() {
    for (int row = 0; row < int(row_values_.size()); ++row) {
      for (const double sign : {1.0, -1.0}) new_.add(1, &row, &sign, {}, 1);
    }
    fixed_columns_ = new_.count();
  }

  void add_reaction(const BalanceReaction& r) {
    const double unit = unit_of(island_, r.a, r.b);
    const Range range{r.one_sided ? 0 : -r.limit / unit, r.limit / unit};
    add_column(r.a, r.b, {r.force, r.torque}, r.point, unit, range);
    reaction_units_.push_back(unit);
    ++fixed_columns_;
  }

  void add_first_directions(int c) {
    const BalanceContact& contact = island_.contacts[std::size_t(c)];
    if (contact.friction <= 0) return add_direction(c, {});
    // One of them uphill, where friction is needed most.
    const Vec3 up{0, 0, 1};
    Vec3 uphill = up - contact.normal * dot(up, contact.normal);
    if (norm(uphill) < 1e-6) uphill = {1, 0, 0};
    const Vec3 u = normalized(uphill), v = cross(contact.normal, u);
    static_assert(kFirstDirections == 4);
    for (const Vec3& tangent : {u, v, -u, -v}) add_direction(c, tangent);
  }

  void add_direction(int c, const Vec3& tangent) {
    const BalanceContact& contact = island_.contacts[std::size_t(c)];
    const Column column{c, contact.normal + tangent * contact.friction,
                        unit_of(island_, contact.a, contact.b)};
    add_column(contact.a, contact.b, {column.direction, {}}, contact.point, column.unit, {});
    columns_.push_back(column);
  }

  void add_column(int a, int b, const Wrench& on_b, const Vec3& point, double unit,
                  const Range& range) {
    int rows[2 * kRows];
    double elements[2 * kRows];
    int count = 0;
    for (int side = 0; side < 2; ++side) {
      const int i = side == 0 ? a : b;
      if (i == kImmovable) continue;
      const BalanceBody& body = island_.bodies[std::size_t(i)];
      const double sign = side == 0 ? -unit : unit;
      const Vec3 force = on_b.force * (sign / body.weight);
      const Vec3 torque = (on_b.torque + cross(point - body.centre, on_b.force)) *
                          (sign / (body.weight * body.length));
      for (int k = 0; k < kRows; ++k) {
        rows[count] = kRows * i + k;
        elements[count++] = k < 3 ? force[k] : torque[k - 3];
      }
    }
    new_.add(count, rows, elements, range, 0);
  }

  void load() {
    const CoinPackedMatrix matrix(true, int(row_values_.size()), new_.count(),
                                  CoinBigIndex(new_.rows.size()), new_.elements.data(),
                                  new_.rows.data(), new_.starts.data(), nullptr);
    clp_.loadProblem(matrix, new_.lower.data(), new_.upper.data(), new_.costs.data(),
                     row_values_.data(), row_values_.data());
    new_ = {};
  }

  void flush() {
    clp_.addColumns(new_.count(), new_.lower.data(), new_.upper.data(), new_.costs.data(),
                    new_.starts.data(), new_.rows.data(), new_.elements.data());
    new_ = {};
  }

  // The virtual velocity of a body at a point, by the duals of its rows.
  Vec3 velocity_of(int i, const Vec3& point, const double* duals) const {
    if (i == kImmovable) return {};
    const BalanceBody& body = island_.bodies[std::size_t(i)];
    const double* y = duals + kRows * i;
    const Vec3 linear = Vec3{y[0], y[1], y[2]} * (1 / body.weight);
    const Vec3 angular = Vec3{y[3], y[4], y[5]} * (1 / (body.weight * body.length));
    return linear + cross(angular, point - body.centre);
  }

  // Adds the best direction of every cone that would help; false when none does.
  bool price() {
    const double* duals = clp_.dualRowSolution();
    const std::size_t before = columns_.size();
    for (std::size_t c = 0; c < island_.contacts.size(); ++c) {
      const BalanceContact& contact = island_.contacts[c];
      const Vec3 v = velocity_of(contact.b, contact.point, duals) -
                     velocity_of(contact.a, contact.point, duals);
      const double along = dot(v, contact.normal);
      const Vec3 sliding = v - contact.normal * along;
      const double gain = along + contact.friction * norm(sliding);
      if (gain * unit_of(island_, contact.a, contact.b) > kGain)
        add_direction(int(c), normalized(sliding));
    }
    if (columns_.size() == before) return false;
    flush();
    return true;
  }

  void read(IslandForces& forces) const {
    const double* x = clp_.primalColumnSolution();
    const std::size_t reactions = island_.reactions.size();
    const std::size_t slacks = std::size_t(fixed_columns_) - reactions;
    for (std::size_t i = 0; i < reactions; ++i) {
      const double factor = x[slacks + i] * reaction_units_[i];
      const BalanceReaction& r = island_.reactions[i];
      const double least = r.one_sided ? 0 : -r.limit;
      forces.reaction_factor.push_back(std::min(r.limit, std::max(least, factor)));
    }
    forces.contact_force.resize(island_.contacts.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const double factor = std::max(x[std::size_t(fixed_columns_) + i], 0.0) * columns_[i].unit;
      forces.contact_force[std::size_t(columns_[i].contact)] += columns_[i].direction * factor;
    }
  }

  const BalanceProblem& island_;
  ClpSimplex clp_;
  Columns new_;
  std::vector<double> row_values_;  // the loads, negative
  std::vector<Column> columns_;
  std::vector<double> reaction_units_;
  int fixed_columns_ = 0;  // slacks and reactions, before those of contacts
};

}  // namespace

IslandForces solve_island(const BalanceProblem& island) {
  try {
    return Program(island).solve();
  } catch (const CoinError& error) {
    throw RunError("Clp: " + error.message() + " in " + error.className() + "::" +
                   error.methodName());
  }
}

}  // namespace rubble
