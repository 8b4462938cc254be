// The rows of TreeContacts: made at the start of a step; those of friction in each substep.
#include <algorithm>
#include <cmath>

#include "kernel/solver/contact_law.h"
#include "kernel/solver/contact_solver.h"
#include "kernel/solver/tree_contacts.h"

namespace rubble {
namespace {

// Below this share of the answer of a free point mass as heavy as its tree, a row within a tree
// counts as held by the tree's joints.
constexpr double kRedundant = 1e-6;

// Where the determinant of J M^-1 J^T of the two tangents is less than this share of its trace squared, or a principal
// value less than this share of its trace, what is left of it is rounding; unit: 1.
constexpr double kOneWay = 1e-12;
// Where the normal leans towards a belt's axis until its part across is less than this, the surface is the
// belt's edge, which slows down to nothing at the end of the axis; unit: 1.
constexpr double kBeltEdge = 0.5;

// Places of the links in a walk along the tree, each branch after the other.
std::vector<std::int32_t> calc_places(const Tree& tree) {
  const std::size_t count = tree.links.size();
  std::vector<std::int32_t> sizes(count, 1), places(count, 0), next(count, 1);
  for (std::size_t i = count; i-- > 1;) {
    sizes[std::size_t(tree.links[i].parent)] += sizes[i];
  }
  for (std::size_t i = 1; i < count; ++i) {
    std::int32_t& free = next[std::size_t(tree.links[i].parent)];
    places[i] = free;
    free += sizes[i];
    next[i] = places[i] + 1;
  }
  return places;
}

}  // namespace

// Fills the rows of one contact.
class TreeContacts::Builder {
 public:
  Builder(TreeContacts& all, const std::vector<Body>& bodies,
          const std::vector<std::int32_t>& number, const std::vector<float>& share)
      : all_(all), bodies_(bodies), number_(number), share_(share) {}

  void add(const SolverSettings& settings, const Contact& contact, std::int32_t index) {
    Item item;
    item.source = index;
    item.friction = double(contact.friction);
    item.normal = Vec3(contact.normal);
    item.sides[0] = side_of(contact.body_a);
    item.sides[1] = side_of(contact.body_b);
    all_.couple_sides(item);
    item.first_row = all_.rows_.size();
    item.rows = contact.count;
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      NormalRow n;
      n.from_a = Vec3(p.from_a);
      n.from_b = Vec3(p.from_b);
      n.row = all_.make_row(item, force_at(item.sides[0].arm + n.from_a, item.normal * -1.0),
                            force_at(item.sides[1].arm + n.from_b, item.normal));
      n.row.impulse = n.carried = double(p.normal_impulse);
      n.gap = double(p.separation) - double(settings.rest_gap);
      n.push_mass = all_.calc_push_mass(item, n.row);
      all_.rows_.push_back(n);
    }
    add_friction(item, contact);
    all_.items_.push_back(item);
  }

 private:
  Side side_of(std::int32_t index) const {
    if (index == kGround || !bodies_[std::size_t(index)].awake) return {};
    const Body& body = bodies_[std::size_t(index)];
    if (body.tree >= 0) return all_.link_side(body.tree, body.link);
    Side side;
    side.number = number_[std::size_t(index)];
    const double share = double(share_[std::size_t(side.number)]);
    side.push_weight = body.mass / share;
    side.inverse_mass = share / body.mass;
    const Mat3f& m = body.inverse_inertia;
    side.inverse_inertia = Mat3{{Vec3(m.rows[0]), Vec3(m.rows[1]), Vec3(m.rows[2])}} * share;
    return side;
  }

  // Of the belt that runs round a link, against the link, where its surface faces `outwards`.
  Vec3 belt_velocity(std::int32_t index, const Vec3& outwards) const {
    if (index == kGround || bodies_[std::size_t(index)].tree < 0) return {};
    const Body& body = bodies_[std::size_t(index)];
    if (!body.awake) return {};
    const TreeLink& link = all_.motion(body.tree).tree().links[std::size_t(body.link)];
    if (link.belt_speed == 0) return {};
    if (norm(link.eversion_axis) > 0) {  // backwards at the sides, at rest at the very front
      const Vec3 axis = body.world_from_com.rotation.rotate(link.eversion_axis);
      return (outwards * dot(axis, outwards) - axis) * link.belt_speed;
    }
    const Vec3 along = cross(body.world_from_com.rotation.rotate(link.belt_axis), outwards);
    return along * (link.belt_speed / std::max(norm(along), kBeltEdge));
  }

  void add_friction(Item& item, const Contact& contact) {
    const Vec3& n = item.normal;
    item.tangents[0] =
        normalized(cross(n, std::abs(n.x) < 0.57735 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    item.tangents[1] = cross(n, item.tangents[0]);
    const Vec3 belt = belt_velocity(contact.body_b, n * -1.0) - belt_velocity(contact.body_a, n);
    for (int t = 0; t < 2; ++t) {
      item.slide[t].impulse = dot(item.tangents[t], Vec3(contact.friction_impulse));
      item.belt[t] = dot(item.tangents[t], belt);
    }
    for (const Side& side : item.sides) {
      item.driven = item.driven || (side.tree >= 0 && all_.motion(side.tree).tree().driven);
    }
    item.twist = all_.make_row(item, {n * -1.0, {}}, {n, {}});
    item.twist.impulse = double(contact.twist_impulse);
  }

  TreeContacts& all_;
  const std::vector<Body>& bodies_;
  const std::vector<std::int32_t>& number_;
  const std::vector<float>& share_;
};

TreeContacts::Side TreeContacts::link_side(std::int32_t tree, std::int32_t link) const {
  Side side;
  side.tree = tree;
  side.link = link;
  side.push_weight = motion(tree).tree().mass;
  side.response = &motion(tree).inertia().response(link);
  side.arm = motion(tree).pose().links[std::size_t(link)].centre;
  return side;
}

void TreeContacts::couple_sides(Item& item) {
  const Side &a = item.sides[0], &b = item.sides[1];
  if (b.tree < 0 && b.number < 0) item.moving = 1;
  if (a.tree < 0 || a.tree != b.tree) return;
  item.cross = std::int32_t(crosses_.size());
  crosses_.push_back(motion(a.tree).inertia().calc_cross_response(a.link, b.link));
}

TreeContacts::Row TreeContacts::make_row(const Item& item, const Spatial& a,
                                         const Spatial& b) const {
  Row row;
  set_row(item, a, b, row);
  // What other joints hold already leaves nothing but rounding; so do the first hinges of a staked tube.
  double least = 0;
  for (int s = 0; s < 2; ++s) {
    const Side& side = item.sides[s];
    if (item.cross < 0 && (side.tree < 0 || !motion(side.tree).tree().tube)) continue;
    least = std::max(least, kRedundant * dot(row.jacobian[s], row.jacobian[s]) /
                                side.push_weight);
  }
  const double sum = row.couple<2>(row);
  row.mass = sum > least ? 1 / sum : 0;
  return row;
}

void TreeContacts::set_row(const Item& item, const Spatial& a, const Spatial& b, Row& row) const {
  const Spatial* forces[2] = {&a, &b};
  for (int s = 0; s < 2; ++s) {
    const Side& side = item.sides[s];
    const Spatial& force = *forces[s];
    if (side.tree >= 0) {
      row.jacobian[s] = force;
      row.response[s] = *side.response * force;
    } else if (side.number >= 0) {
      row.jacobian[s] = force;
      row.response[s] = {side.inverse_inertia * force.angular(),
                         force.linear() * side.inverse_mass};
    }
  }
  if (item.cross >= 0) {
    const SpatialMatrix& cross = crosses_[std::size_t(item.cross)];
    row.response[0] += cross * b;
    row.response[1] += cross.transposed_times(a);
  }
}

// Free pieces count as equally heavy, as in the push rows of other contacts; trees as a whole too.
double TreeContacts::calc_push_mass(const Item& item, const Row& row) const {
  if (row.mass == 0) return 0;
  double sum = 0;
  for (int s = 0; s < 2; ++s) {
    sum += dot(row.jacobian[s], row.response[s]) * item.sides[s].push_weight;
  }
  return sum > 0 ? 1 / sum : 0;
}

// Friction acts at the centre of the points, weighted by what pressed them last.
void TreeContacts::place_friction(Item& item) {
  if (item.moving == 1) {
    place_friction_of<1>(item);
  } else {
    place_friction_of<2>(item);
  }
}

// As find_first_loads() of rows/contact_prepare.h.
template <int sides>
double TreeContacts::find_first_loads(const Item& item, double* loads) const {
  const NormalRow* rows = &rows_[item.first_row];
  double sum = 0;
  for (int i = 0; i < item.rows; ++i) loads[i] = 0;
  for (int sweep = 0; sweep < contact_law::kLoadSweeps; ++sweep) {
    for (int k = 0; k < item.rows; ++k) {
      const int i = sweep % 2 == 0 ? k : item.rows - 1 - k;
      double speed = -1;
      for (int j = 0; j < item.rows; ++j) speed += rows[i].row.couple<sides>(rows[j].row) * loads[j];
      const double next = std::max(0.0, loads[i] - rows[i].row.mass * speed);
      sum += next - loads[i];
      loads[i] = next;
    }
  }
  return sum;
}

template <int sides>
void TreeContacts::place_friction_of(Item& item) {
  const NormalRow* rows = &rows_[item.first_row];
  double loads[Contact::kMaxPoints], sum = sum_impulses(item);
  for (int i = 0; i < item.rows; ++i) loads[i] = rows[i].row.impulse;
  if (sum <= 0 && !item.driven) sum = find_first_loads<sides>(item, loads);
  const auto shares = contact_law::find_centre_shares<double>(sum, double(item.rows));
  Vec3 centre_a, centre_b;
  double share[Contact::kMaxPoints];
  for (int i = 0; i < item.rows; ++i) {
    share[i] = shares.each + shares.per_impulse * loads[i];
    centre_a += rows[i].from_a * share[i];
    if (sides == 2) centre_b += rows[i].from_b * share[i];
  }
  item.radius = 0;
  for (int i = 0; i < item.rows; ++i) item.radius += share[i] * norm(rows[i].from_a - centre_a);
  if (!item.driven) item.radius *= double(contact_law::mean_radius_share(item.rows));
  item.radius = std::max(item.radius, double(contact_law::kPatchRadius));
  for (int t = 0; t < 2; ++t) {
    const Vec3& along = item.tangents[t];
    set_row(item, force_at(item.sides[0].arm + centre_a, along * -1.0),
            force_at(item.sides[1].arm + centre_b, along), item.slide[t]);
  }
  const Row &r = item.slide[0], &s = item.slide[1];
  const double k00 = r.couple<sides>(r), k01 = r.couple<sides>(s), k11 = s.couple<sides>(s);
  if (item.driven) return note_driven_slide(item, k00, k01, k11);
  item.axes = find_friction_axes(k00, k01, k11);
  const double c = item.axes.cosine, d = item.axes.sine;
  const double along[2] = {c * c * k00 + 2 * c * d * k01 + d * d * k11, d * d * k00 - 2 * c * d * k01 + c * c * k11};
  // A link with one hinge to something immovable slides along one line only.
  for (int t = 0; t < 2; ++t) item.slide[t].mass = along[t] > kOneWay * (k00 + k11) ? 1 / along[t] : 0;
}

void TreeContacts::note_driven_slide(Item& item, double k00, double k01, double k11) {
  const double determinant = k00 * k11 - k01 * k01;
  const double inverse = determinant > 0 ? 1 / determinant : 0;
  item.slide_matrix[0] = k00, item.slide_matrix[1] = k01, item.slide_matrix[2] = k11;
  // A link with one hinge to the ground slides along one line only: K is lambda a a^T, and K / lambda^2 takes
  // the place of its inverse.
  const double trace = k00 + k11;
  item.one_way = determinant <= kOneWay * trace * trace;
  if (item.one_way) {
    const double scale = trace > 0 ? 1 / (trace * trace) : 0;
    item.slide_inverse[0] = k00 * scale, item.slide_inverse[1] = k01 * scale, item.slide_inverse[2] = k11 * scale;
    return;
  }
  item.slide_inverse[0] = k11 * inverse;
  item.slide_inverse[1] = -k01 * inverse;
  item.slide_inverse[2] = k00 * inverse;
}

void TreeContacts::sort_items(const std::vector<Body>& bodies,
                              const std::vector<std::int32_t>& order,
                              const std::vector<Contact>& contacts) {
  std::vector<std::int32_t> rank(trees_.motions->size(), -1);
  std::int32_t ranks = 0;
  const auto note = [&](std::int32_t tree) {
    if (tree >= 0 && rank[std::size_t(tree)] < 0) rank[std::size_t(tree)] = ranks++;
  };
  for (std::int32_t index : order) {
    const Contact& contact = contacts[std::size_t(index)];
    note(bodies[std::size_t(contact.body_a)].tree);
    if (contact.body_b != kGround) note(bodies[std::size_t(contact.body_b)].tree);
  }
  for (std::int32_t tree : trees_.trees) note(tree);
  std::vector<std::vector<std::int32_t>> places(trees_.motions->size());
  for (std::int32_t tree : trees_.trees) {
    places[std::size_t(tree)] = calc_places(motion(tree).tree());
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> keys;
  for (const Item& item : items_) {
    std::pair<std::int32_t, std::int32_t> key{ranks, 0};
    for (const Side& side : item.sides) {
      if (side.tree < 0) continue;
      const std::pair<std::int32_t, std::int32_t> own{
          rank[std::size_t(side.tree)],
          places[std::size_t(side.tree)][std::size_t(side.link)]};
      if (own.first < key.first || item.cross >= 0) key = own;
    }
    keys.push_back(key);
  }
  sequence_.resize(items_.size());
  for (std::size_t i = 0; i < items_.size(); ++i) sequence_[i] = std::int32_t(i);
  std::stable_sort(sequence_.begin(), sequence_.end(), [&](std::int32_t a, std::int32_t b) {
    return keys[std::size_t(a)] < keys[std::size_t(b)];
  });
}

void TreeContacts::mark_loaded(const std::vector<Body>& bodies,
                               const std::vector<std::int32_t>& order,
                               const std::vector<Contact>& contacts) {
  std::vector<std::uint8_t> loaded(trees_.motions->size(), 0);
  for (std::int32_t index : order) {
    const Contact& contact = contacts[std::size_t(index)];
    if (contact.body_b == kGround) continue;
    const Body &a = bodies[std::size_t(contact.body_a)], &b = bodies[std::size_t(contact.body_b)];
    if (a.tree >= 0 && b.awake && b.mass > a.mass) loaded[std::size_t(a.tree)] = 1;
    if (b.tree >= 0 && a.awake && a.mass > b.mass) loaded[std::size_t(b.tree)] = 1;
  }
  for (Item& item : items_) {
    for (const Side& side : item.sides) {
      item.loaded = item.loaded || (side.tree >= 0 && loaded[std::size_t(side.tree)] != 0);
    }
  }
}

void TreeContacts::begin(const SolverSettings& settings, const std::vector<Body>& bodies,
                         const std::vector<std::int32_t>& order,
                         const std::vector<Contact>& contacts,
                         const std::vector<std::int32_t>& number, const std::vector<float>& share,
                         const SolvedTrees& trees) {
  trees_ = trees;
  items_.clear();
  rows_.clear();
  crosses_.clear();
  if (empty()) return;
  substep_ = double(settings.step) / settings.substeps;
  for (std::int32_t tree : trees_.trees) {
    motion(tree).begin_substeps(substep_);
    add_stops(tree);
    add_dry_friction(tree);
    add_motors(tree);
    add_loops(bodies, tree);
  }
  Builder builder(*this, bodies, number, share);
  for (std::int32_t index : order) builder.add(settings, contacts[std::size_t(index)], index);
  sort_items(bodies, order, contacts);
  mark_loaded(bodies, order, contacts);
}

}  // namespace rubble
