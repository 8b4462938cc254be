#include "kernel/structure/stress.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/structure/bond_stiffness.h"
#include "kernel/structure/factor/updated_factor.h"

namespace rubble {
namespace {

constexpr int kMostChanges = 192;     // that a factor follows before it is made anew; unit: 1
// What comes off may cut more than that at once: up to here this costs less than a new factor. unit: 1
constexpr int kMostCuts = 384;
constexpr int kPiecesPerChange = 8;  // at least: the factor of a small group costs less; unit: 1
constexpr double kResidual = 1e-6;  // of the loads: more, and the factor is made anew; unit: 1

double product(const std::vector<Six>& a, const std::vector<Six>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int k = 0; k < 6; ++k) sum += a[i][k] * b[i][k];
  }
  return sum;
}

bool is_zero(const Six& v) {
  return std::all_of(v.begin(), v.end(), [](double x) { return x == 0; });
}

StressResult unstable(StressResult result) {
  result.stable = false;
  return result;
}

}  // namespace

std::vector<PieceLoad> calc_weights(const Structure& structure, double gravity) {
  std::vector<PieceLoad> loads(structure.pieces.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    loads[i].force = {0, 0, -structure.pieces[i].mass * gravity};
  }
  return loads;
}

struct GroupStress::Impl {
  // A bond of the group, and which stiffness of it the factor knows.
  struct Link {
    std::int32_t a = 0, b = -1;  // within the members; b: -1 the foundation
    BondLink link;
    Six stiffness{};
  };
  // Holds what nothing else anchors; carries nothing, since the loads on it balance.
  struct Spring {
    std::int32_t member = 0;
    Six stiffness{};
  };

  const Structure* structure = nullptr;
  BondGroup group;
  StressOptions options;
  std::vector<std::int32_t> members;  // pieces of the factor, ascending; those that came off too
  std::vector<Link> links;            // by bond of the group
  std::vector<Spring> springs;
  UpdatedFactor factor;
  bool made = false, regular = false;
  int factors_made = 0;
  std::vector<BondStatus> now;  // by bond of the group

  Impl(const Structure& s, BondGroup g, const StressOptions& o)
      : structure(&s), group(std::move(g)), options(o) {
    begin();
  }

  // As if nothing had been solved yet.
  void begin() {
    members = group.pieces;
    made = false;
    springs.clear();
    links.clear();
    for (const std::int32_t index : group.bonds) links.push_back(make_member_link(index));
  }

  Link make_member_link(std::int32_t index) const {
    const Bond& bond = structure->bonds[index];
    Link result;
    result.a = member_of(bond.piece_a);
    if (bond.piece_b != kFoundation) result.b = member_of(bond.piece_b);
    result.link = make_link(*structure, bond);
    return result;
  }

  std::int32_t member_of(std::int32_t piece) const {
    return std::int32_t(std::lower_bound(members.begin(), members.end(), piece) - members.begin());
  }

  const Bond& bond(std::size_t i) const { return structure->bonds[group.bonds[i]]; }

  // What the bonds hold a member by, in each of its six directions.
  Six held_by(std::int32_t member) const {
    Six diagonal{};
    for (const Link& link : links) {
      if (link.a != member && link.b != member) continue;
      const Block6& at = link.a == member ? link.link.at_a : link.link.at_b;
      for (int c = 0; c < 6; ++c) {
        for (int r = 0; r < 6; ++r) diagonal[c] += at[6 * r + c] * link.stiffness[r] * at[6 * r + c];
      }
    }
    return diagonal;
  }

  BlockMatrix assemble() const {
    BlockMatrix matrix;
    matrix.diagonal.assign(members.size(), Block6{});
    for (const std::int32_t piece : members) matrix.places.push_back(structure->pieces[piece].centre);
    for (const Link& l : links) {
      const Block6 &at_a = l.link.at_a, &at_b = l.link.at_b;
      add(matrix.diagonal[l.a], weighted_product(at_a, l.stiffness, at_a));
      if (l.b < 0) continue;
      add(matrix.diagonal[l.b], weighted_product(at_b, l.stiffness, at_b));
      BlockEntry entry{std::max(l.a, l.b), std::min(l.a, l.b), {}};
      const bool a_is_row = l.a > l.b;
      add(entry.values, weighted_product(a_is_row ? at_a : at_b, l.stiffness, a_is_row ? at_b : at_a), -1);
      matrix.below.push_back(entry);
    }
    for (const Spring& spring : springs) {
      for (int i = 0; i < 6; ++i) matrix.diagonal[spring.member][7 * i] += spring.stiffness[i];
    }
    return matrix;
  }

  // K u, bond by bond; only what belongs to the group.
  std::vector<Six> apply(const std::vector<Six>& u) const {
    std::vector<Six> result(u.size(), Six{});
    for (const Link& link : links) {
      Six pull = opening(link, u);
      for (int r = 0; r < 6; ++r) pull[r] *= link.stiffness[r];
      add_transposed_product(result[link.a], link.link.at_a, pull, -1);
      if (link.b >= 0) add_transposed_product(result[link.b], link.link.at_b, pull, 1);
    }
    for (const Spring& spring : springs) {
      for (int i = 0; i < 6; ++i) result[spring.member][i] += spring.stiffness[i] * u[spring.member][i];
    }
    return result;
  }

  // How far the second piece leaves the first at the section.
  static Six opening(const Link& link, const std::vector<Six>& u) {
    const Six of_a = multiply(link.link.at_a, u[link.a]);
    Six result = link.b >= 0 ? multiply(link.link.at_b, u[link.b]) : Six{};
    for (int r = 0; r < 6; ++r) result[r] -= of_a[r];
    return result;
  }

  std::vector<Six> right_side(const std::vector<PieceLoad>& loads) const {
    std::vector<Six> right(members.size(), Six{});
    for (const std::int32_t piece : group.pieces) {
      const PieceLoad& load = loads[piece];
      right[member_of(piece)] = {load.force.x,  load.force.y,  load.force.z,
                                 load.moment.x, load.moment.y, load.moment.z};
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Six offset = calc_offset(bond(i), now[i]);
      if (is_zero(offset)) continue;
      add_transposed_product(right[links[i].a], links[i].link.at_a, offset, 1);
      if (links[i].b >= 0) add_transposed_product(right[links[i].b], links[i].link.at_b, offset, -1);
    }
    return right;
  }

  StressResult read(const std::vector<Six>& u) const {
    StressResult result;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Six& k = links[i].stiffness;
      const Six offset = calc_offset(bond(i), now[i]), open = opening(links[i], u);
      Six q;
      for (int r = 0; r < 6; ++r) q[r] = k[r] * open[r] + offset[r];
      result.forces.push_back({q[0], q[1], q[2], q[3], q[4], q[5]});
      result.rotation_s.push_back(open[4]);
      result.rotation_t.push_back(open[5]);
      result.rotation_n.push_back(open[3]);
    }
    return result;
  }

  // Gives a bond another stiffness in the factor, direction by direction.
  void change(Link& link, const Six& stiffness) {
    for (int r = 0; r < 6; ++r) {
      const double more = stiffness[r] - link.stiffness[r];
      if (more == 0) continue;
      std::vector<BlockValue> v = {{link.a, row_of(link.link.at_a, r, -1)}};
      if (link.b >= 0) v.push_back({link.b, row_of(link.link.at_b, r, 1)});
      factor.change(v, more);
    }
    link.stiffness = stiffness;
  }

  static Six row_of(const Block6& m, int row, double sign) {
    Six result;
    for (int k = 0; k < 6; ++k) result[k] = sign * m[6 * row + k];
    return result;
  }

  void hold(std::int32_t member, const Six& stiffness) {
    springs.push_back({member, stiffness});
    for (int i = 0; i < 6; ++i) {
      BlockValue v{member, {}};
      v.value[i] = 1;
      factor.change({v}, stiffness[i]);
    }
  }

  int most_changes() const { return std::min(kMostChanges, int(members.size()) / kPiecesPerChange); }

  // Changes by which the bonds differ from what the factor knows.
  int count_changes() const {
    int count = 0;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Six k = calc_stiffness(bond(i), now[i]);
      for (int r = 0; r < 6; ++r) count += k[r] != links[i].stiffness[r];
    }
    return count;
  }

  // Brings the factor to the bonds as they are now.
  bool follow() {
    const int changes = made && regular ? count_changes() : 0;
    if (made && regular && changes == 0) return true;
    if (!made || !regular || factor.rank() + changes > most_changes()) return refactor();
    for (std::size_t i = 0; i < links.size(); ++i) change(links[i], calc_stiffness(bond(i), now[i]));
    return true;
  }

  bool refactor() {
    begin();
    for (std::size_t i = 0; i < links.size(); ++i) links[i].stiffness = calc_stiffness(bond(i), now[i]);
    if (!group.anchored) {
      const std::int32_t last = std::int32_t(members.size()) - 1;
      springs.push_back({last, held_by(last)});
    }
    made = true;
    ++factors_made;
    return regular = factor.reset(assemble());
  }

  // False when the factor has followed too many changes to be exact.
  bool solve_followed(const std::vector<Six>& right, std::vector<Six>& u) {
    if (!factor.solve(right, u)) return false;
    if (factor.rank() == 0) return true;
    std::vector<Six> rest = apply(u);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      for (int k = 0; k < 6; ++k) rest[i][k] = right[i][k] - rest[i][k];
    }
    return product(rest, rest) <= kResidual * kResidual * product(right, right);
  }

  StressResult solve_second_order(const std::vector<Six>& right, const StressResult& first) const {
    BlockMatrix matrix = assemble();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Section& s = bond(i).section;
      const SectionForces& f = first.forces[i];
      const Vec3 on_a = s.normal * f.axial + s.axis_s * f.shear_s + s.axis_t * f.shear_t;
      add_turned_force(matrix.diagonal[links[i].a], links[i].link.arm_a, on_a);
      if (links[i].b >= 0) add_turned_force(matrix.diagonal[links[i].b], links[i].link.arm_b, -on_a);
    }
    BlockCholesky bent;
    if (!bent.factorize(matrix)) return unstable(first);
    return read(bent.solve(right));
  }

  StressResult solve(const std::vector<BondStatus>& status, const std::vector<PieceLoad>& loads) {
    now.clear();
    for (const std::int32_t i : group.bonds) now.push_back(status[i]);
    std::vector<Six> u;
    bool solved = follow() && solve_followed(right_side(loads), u);
    if (!solved) solved = refactor() && solve_followed(right_side(loads), u);
    if (!solved) return unstable(read(std::vector<Six>(members.size(), Six{})));
    const StressResult first = read(u);
    return options.second_order ? solve_second_order(right_side(loads), first) : first;
  }

  bool has(std::int32_t member) const {
    return std::binary_search(group.pieces.begin(), group.pieces.end(), members[member]);
  }

  // What remains when pieces came off: their bonds to it are taken out of the factor. They stay in the
  // factor, without loads, and are held there so that it stays regular.
  void leave(BondGroup left) {
    const BondGroup whole = std::exchange(group, std::move(left));
    if (!made || !regular || options.second_order || 2 * group.pieces.size() < members.size()) return begin();
    std::vector<Spring> grips;
    for (const std::int32_t member : find_loose(whole)) grips.push_back({member, held_by(member)});
    std::vector<std::size_t> kept, cut;
    int changes = 6 * int(grips.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Link& link = links[i];
      if (std::binary_search(group.bonds.begin(), group.bonds.end(), whole.bonds[i])) {
        kept.push_back(i);
      } else if (has(link.a) || (link.b >= 0 && has(link.b))) {
        cut.push_back(i);
        changes += int(std::count_if(link.stiffness.begin(), link.stiffness.end(), [](double k) { return k != 0; }));
      }
    }
    if (factor.rank() + changes > kMostCuts) return begin();
    for (const std::size_t i : cut) change(links[i], Six{});
    std::vector<Link> left_links;
    for (const std::size_t i : kept) left_links.push_back(links[i]);
    links = std::move(left_links);
    for (const Spring& grip : grips) hold(grip.member, grip.stiffness);
    springs.erase(std::remove_if(springs.begin(), springs.end(),
                                 [this](const Spring& spring) { return !has(spring.member); }),
                  springs.end());
  }

  // The lowest member of each part that nothing holds: of what came off a whole, and of what is left.
  std::vector<std::int32_t> find_loose(const BondGroup& whole) const {
    JoinedSets parts(members.size());
    std::vector<std::uint8_t> held(members.size(), 0), part_held(members.size(), 0);
    const std::int32_t first = member_of(group.pieces[0]);
    for (const std::int32_t piece : group.pieces) parts.join(first, member_of(piece));
    held[first] = group.anchored;
    for (const Spring& spring : springs) held[spring.member] = 1;
    for (const Link& link : links) {
      if (is_zero(link.stiffness) || has(link.a)) continue;
      if (link.b < 0) {
        held[link.a] = 1;
      } else if (!has(link.b)) {
        parts.join(link.a, link.b);
      }
    }
    for (std::size_t m = 0; m < held.size(); ++m) {
      if (held[m]) part_held[parts.find(std::int32_t(m))] = 1;
    }
    std::vector<std::int32_t> loose;
    for (const std::int32_t piece : whole.pieces) {
      const std::int32_t m = member_of(piece);
      if (parts.find(m) == m && !part_held[m]) loose.push_back(m);
    }
    return loose;
  }
};

GroupStress::GroupStress(const Structure& structure, BondGroup group, const StressOptions& options)
    : impl_(std::make_unique<Impl>(structure, std::move(group), options)) {}
GroupStress::GroupStress(GroupStress&& whole, BondGroup left) : impl_(std::move(whole.impl_)) {
  impl_->leave(std::move(left));
}
GroupStress::~GroupStress() = default;
GroupStress::GroupStress(GroupStress&&) noexcept = default;
GroupStress& GroupStress::operator=(GroupStress&&) noexcept = default;
const BondGroup& GroupStress::group() const { return impl_->group; }
int GroupStress::factors_made() const { return impl_->factors_made; }
StressResult GroupStress::solve(const std::vector<BondStatus>& status,
                                const std::vector<PieceLoad>& loads) {
  return impl_->solve(status, loads);
}

}  // namespace rubble
