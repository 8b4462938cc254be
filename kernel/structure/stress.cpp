#include "kernel/structure/stress.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace rubble {
namespace {

constexpr double kHinge = 1e-4;     // a hinge's share of the elastic stiffness: keeps the factor regular; unit: 1
constexpr int kUpdatedBonds = 4;       // that changed are solved on the old factor; more make a new one; unit: 1
constexpr int kUpdateIterations = 24;  // on an old factor, before a new one is made
constexpr double kResidual = 1e-6;   // of the loads, at which the iteration ends; unit: 1

// Displacement and rotation of a piece to those at the section, in the section's axes.
Block6 at_section(const Section& s, const Vec3& arm) {
  Block6 b{};
  const Vec3 axes[3] = {s.normal, s.axis_s, s.axis_t};
  for (int i = 0; i < 3; ++i) {
    const Vec3 turned = cross(arm, axes[i]);  // axis . (rotation x arm)
    for (int k = 0; k < 3; ++k) {
      b[6 * i + k] = axes[i][k];
      b[6 * i + 3 + k] = turned[k];
      b[6 * (i + 3) + 3 + k] = axes[i][k];
    }
  }
  return b;
}

// A^T diag(d) B.
Block6 weighted_product(const Block6& a, const Six& d, const Block6& b) {
  Block6 result{};
  for (int r = 0; r < 6; ++r) {
    for (int i = 0; i < 6; ++i) {
      const double scaled = a[6 * r + i] * d[r];
      for (int j = 0; j < 6; ++j) result[6 * i + j] += scaled * b[6 * r + j];
    }
  }
  return result;
}

Six multiply(const Block6& m, const Six& v) {
  Six result{};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) result[i] += m[6 * i + k] * v[k];
  }
  return result;
}

void add_transposed_product(Six& target, const Block6& m, const Six& v, double sign) {
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) target[k] += sign * m[6 * i + k] * v[i];
  }
}

void add(Block6& target, const Block6& m, double sign = 1) {
  for (std::size_t i = 0; i < target.size(); ++i) target[i] += sign * m[i];
}

// Order of a section's six: axial, shear s, shear t, torque, moment s, moment t.
Six stiffness_of(const Bond& bond, const BondStatus& status) {
  if (status.broken) return {};
  return {bond.axial_stiffness,   bond.shear_stiffness,
          bond.shear_stiffness,   bond.torsion_stiffness * (status.hinge_n ? kHinge : 1.0),
          bond.bending_s_stiffness * (status.hinge_s ? kHinge : 1.0),
          bond.bending_t_stiffness * (status.hinge_t ? kHinge : 1.0)};
}

Six offset_of(const Bond& bond, const BondStatus& status) {
  Six offset{};
  if (status.broken) return offset;
  const Section& s = bond.section;
  offset[0] = bond.axial_stiffness * dot(s.normal, status.sunk);
  offset[1] = bond.shear_stiffness * dot(s.axis_s, status.sunk);
  offset[2] = bond.shear_stiffness * dot(s.axis_t, status.sunk);
  if (status.hinge_n) offset[3] = status.torque;
  if (status.hinge_s) offset[4] = status.moment_s;
  if (status.hinge_t) offset[5] = status.moment_t;
  return offset;
}

// What a force that turns with its piece adds: (rotation x arm) x force, its symmetric part.
void add_turned_force(Block6& diagonal, const Vec3& arm, const Vec3& force) {
  const double along = dot(arm, force);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double turned = (arm[i] * force[k] + force[i] * arm[k]) / 2 - (i == k ? along : 0.0);
      diagonal[6 * (i + 3) + k + 3] -= turned;
    }
  }
}

double product(const std::vector<Six>& a, const std::vector<Six>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int k = 0; k < 6; ++k) sum += a[i][k] * b[i][k];
  }
  return sum;
}

// Sets that grow together, by their lowest member.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t find(std::int32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace

std::vector<BondGroup> find_groups(const Structure& structure, const std::vector<BondStatus>& status,
                                   const std::vector<std::uint8_t>& gone) {
  const std::size_t count = structure.pieces.size();
  const auto is_gone = [&gone](std::int32_t piece) { return !gone.empty() && gone[piece] != 0; };
  const auto holds = [&](std::size_t i) {
    const Bond& bond = structure.bonds[i];
    return !status[i].broken && !is_gone(bond.piece_a) &&
           (bond.piece_b == kFoundation || !is_gone(bond.piece_b));
  };
  Sets sets(count);
  for (std::size_t i = 0; i < structure.bonds.size(); ++i) {
    const Bond& bond = structure.bonds[i];
    if (holds(i) && bond.piece_b != kFoundation) sets.join(bond.piece_a, bond.piece_b);
  }
  std::vector<std::int32_t> number(count, -1);
  std::vector<BondGroup> groups;
  for (std::int32_t i = 0; i < std::int32_t(count); ++i) {
    if (is_gone(i)) continue;
    std::int32_t& group = number[sets.find(i)];
    if (group < 0) {
      group = std::int32_t(groups.size());
      groups.emplace_back();
    }
    groups[group].pieces.push_back(i);
  }
  for (std::size_t i = 0; i < structure.bonds.size(); ++i) {
    if (!holds(i)) continue;
    BondGroup& group = groups[number[sets.find(structure.bonds[i].piece_a)]];
    group.bonds.push_back(std::int32_t(i));
    group.anchored = group.anchored || structure.bonds[i].piece_b == kFoundation;
  }
  return groups;
}

std::vector<PieceLoad> calc_weights(const Structure& structure, double gravity) {
  std::vector<PieceLoad> loads(structure.pieces.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    loads[i].force = {0, 0, -structure.pieces[i].mass * gravity};
  }
  return loads;
}

struct GroupStress::Impl {
  // A bond with what its stiffness turns into at its pieces.
  struct Link {
    std::int32_t a = 0, b = -1;  // within the group; b: -1 the foundation
    Block6 at_a{}, at_b{};
    Vec3 arm_a, arm_b;
  };

  const Structure* structure = nullptr;
  BondGroup group;
  StressOptions options;
  std::vector<Link> links;
  BlockCholesky factor;
  bool made = false, regular = false;
  std::vector<BondStatus> made_for;  // by bond of the group
  std::vector<BondStatus> now;

  Impl(const Structure& s, BondGroup g, const StressOptions& o)
      : structure(&s), group(std::move(g)), options(o) {
    for (const std::int32_t index : group.bonds) links.push_back(make_link(s.bonds[index]));
  }

  std::int32_t local(std::int32_t piece) const {
    return std::int32_t(std::lower_bound(group.pieces.begin(), group.pieces.end(), piece) -
                        group.pieces.begin());
  }

  Link make_link(const Bond& bond) const {
    Link link;
    link.a = local(bond.piece_a);
    link.arm_a = bond.section.centroid - structure->pieces[bond.piece_a].centre;
    link.at_a = at_section(bond.section, link.arm_a);
    if (bond.piece_b == kFoundation) return link;
    link.b = local(bond.piece_b);
    link.arm_b = bond.section.centroid - structure->pieces[bond.piece_b].centre;
    link.at_b = at_section(bond.section, link.arm_b);
    return link;
  }

  const Bond& bond(std::size_t i) const { return structure->bonds[group.bonds[i]]; }

  BlockMatrix assemble() const {
    BlockMatrix matrix;
    matrix.diagonal.assign(group.pieces.size(), Block6{});
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Link& link = links[i];
      const Six k = stiffness_of(bond(i), now[i]);
      add(matrix.diagonal[link.a], weighted_product(link.at_a, k, link.at_a));
      if (link.b < 0) continue;
      add(matrix.diagonal[link.b], weighted_product(link.at_b, k, link.at_b));
      BlockEntry entry{std::max(link.a, link.b), std::min(link.a, link.b), {}};
      const bool a_is_row = link.a > link.b;
      add(entry.values,
          weighted_product(a_is_row ? link.at_a : link.at_b, k, a_is_row ? link.at_b : link.at_a), -1);
      matrix.below.push_back(entry);
    }
    // Balanced loads leave this spring without force.
    if (!group.anchored) {
      for (int i = 0; i < 6; ++i) matrix.diagonal.back()[7 * i] *= 2;
    }
    return matrix;
  }

  // K u, bond by bond.
  std::vector<Six> apply(const std::vector<Six>& u) const {
    std::vector<Six> result(u.size(), Six{});
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Link& link = links[i];
      const Six k = stiffness_of(bond(i), now[i]);
      Six pull = opening(link, u);
      for (int r = 0; r < 6; ++r) pull[r] *= k[r];
      add_transposed_product(result[link.a], link.at_a, pull, -1);
      if (link.b >= 0) add_transposed_product(result[link.b], link.at_b, pull, 1);
    }
    if (!group.anchored) {
      const Six& last = u.back();
      const Six extra = held_by(last);
      for (int i = 0; i < 6; ++i) result.back()[i] += extra[i];
    }
    return result;
  }

  // The spring that holds a free group: as large as what its last piece is held by.
  Six held_by(const Six& u) const {
    Six diagonal{};
    const std::int32_t last = std::int32_t(group.pieces.size()) - 1;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Link& link = links[i];
      if (link.a != last && link.b != last) continue;
      const Block6& at = link.a == last ? link.at_a : link.at_b;
      const Six k = stiffness_of(bond(i), now[i]);
      for (int c = 0; c < 6; ++c) {
        for (int r = 0; r < 6; ++r) diagonal[c] += at[6 * r + c] * k[r] * at[6 * r + c];
      }
    }
    for (int c = 0; c < 6; ++c) diagonal[c] *= u[c];
    return diagonal;
  }

  // How far the second piece leaves the first at the section.
  static Six opening(const Link& link, const std::vector<Six>& u) {
    const Six of_a = multiply(link.at_a, u[link.a]);
    Six result = link.b >= 0 ? multiply(link.at_b, u[link.b]) : Six{};
    for (int r = 0; r < 6; ++r) result[r] -= of_a[r];
    return result;
  }

  std::vector<Six> right_side(const std::vector<PieceLoad>& loads) const {
    std::vector<Six> right(group.pieces.size());
    for (std::size_t i = 0; i < right.size(); ++i) {
      const PieceLoad& load = loads[group.pieces[i]];
      right[i] = {load.force.x, load.force.y, load.force.z, load.moment.x, load.moment.y, load.moment.z};
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Six offset = offset_of(bond(i), now[i]);
      if (std::all_of(offset.begin(), offset.end(), [](double x) { return x == 0; })) continue;
      add_transposed_product(right[links[i].a], links[i].at_a, offset, 1);
      if (links[i].b >= 0) add_transposed_product(right[links[i].b], links[i].at_b, offset, -1);
    }
    return right;
  }

  StressResult read(const std::vector<Six>& u) const {
    StressResult result;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Six k = stiffness_of(bond(i), now[i]), offset = offset_of(bond(i), now[i]);
      const Six open = opening(links[i], u);
      Six q;
      for (int r = 0; r < 6; ++r) q[r] = k[r] * open[r] + offset[r];
      result.forces.push_back({q[0], q[1], q[2], q[3], q[4], q[5]});
      result.rotation_s.push_back(open[4]);
      result.rotation_t.push_back(open[5]);
      result.rotation_n.push_back(open[3]);
    }
    return result;
  }

  bool is_same(const BondStatus& a, const BondStatus& b) const {
    return a.broken == b.broken && a.hinge_s == b.hinge_s && a.hinge_t == b.hinge_t &&
           a.hinge_n == b.hinge_n;
  }

  // Conjugate gradients on the old factor: as many steps as stiffnesses changed, about six a bond.
  // False when that takes too long.
  bool iterate(const std::vector<Six>& right, std::vector<Six>& u) const {
    u = factor.solve(right);
    std::vector<Six> residual = apply(u);
    for (std::size_t i = 0; i < right.size(); ++i) {
      for (int k = 0; k < 6; ++k) residual[i][k] = right[i][k] - residual[i][k];
    }
    std::vector<Six> z = factor.solve(residual), p = z;
    const double target = kResidual * kResidual * product(right, right);
    double rz = product(residual, z);
    for (int round = 0; round < kUpdateIterations; ++round) {
      if (!(product(residual, residual) > target)) return true;
      const std::vector<Six> kp = apply(p);
      const double curvature = product(p, kp);
      if (!(curvature > 0)) return false;
      const double step = rz / curvature;
      for (std::size_t i = 0; i < u.size(); ++i) {
        for (int k = 0; k < 6; ++k) u[i][k] += step * p[i][k], residual[i][k] -= step * kp[i][k];
      }
      z = factor.solve(residual);
      const double next = product(residual, z);
      const double share = next / rz;
      rz = next;
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (int k = 0; k < 6; ++k) p[i][k] = z[i][k] + share * p[i][k];
      }
    }
    return false;
  }

  bool refactor() {
    made_for = now;
    made = true;
    return regular = factor.factorize(assemble());
  }

  StressResult solve_second_order(const std::vector<Six>& right, const StressResult& first) const {
    BlockMatrix matrix = assemble();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Section& s = bond(i).section;
      const SectionForces& f = first.forces[i];
      const Vec3 on_a = s.normal * f.axial + s.axis_s * f.shear_s + s.axis_t * f.shear_t;
      add_turned_force(matrix.diagonal[links[i].a], links[i].arm_a, on_a);
      if (links[i].b >= 0) add_turned_force(matrix.diagonal[links[i].b], links[i].arm_b, -on_a);
    }
    BlockCholesky bent;
    if (!bent.factorize(matrix)) return unstable(first);
    return read(bent.solve(right));
  }

  static StressResult unstable(StressResult result) {
    result.stable = false;
    return result;
  }

  StressResult solve(const std::vector<BondStatus>& status, const std::vector<PieceLoad>& loads) {
    now.clear();
    for (const std::int32_t i : group.bonds) now.push_back(status[i]);
    const std::vector<Six> right = right_side(loads);
    int changes = made && regular ? 0 : kUpdatedBonds + 1;
    for (std::size_t i = 0; made && i < now.size(); ++i) changes += !is_same(now[i], made_for[i]);
    const bool changed = changes > 0;
    std::vector<Six> u;
    const bool quick = changed && changes <= kUpdatedBonds && iterate(right, u);
    if (!quick) {
      if (changed && !refactor()) return unstable(read(std::vector<Six>(right.size(), Six{})));
      u = factor.solve(right);
    }
    const StressResult first = read(u);
    return options.second_order ? solve_second_order(right, first) : first;
  }
};

GroupStress::GroupStress(const Structure& structure, BondGroup group, const StressOptions& options)
    : impl_(std::make_unique<Impl>(structure, std::move(group), options)) {}
GroupStress::~GroupStress() = default;
GroupStress::GroupStress(GroupStress&&) noexcept = default;
GroupStress& GroupStress::operator=(GroupStress&&) noexcept = default;
const BondGroup& GroupStress::group() const { return impl_->group; }
StressResult GroupStress::solve(const std::vector<BondStatus>& status,
                                const std::vector<PieceLoad>& loads) {
  return impl_->solve(status, loads);
}

}  // namespace rubble
