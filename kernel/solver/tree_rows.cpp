// The rows of TreeContacts at the start of a step.
#include <cmath>

#include "kernel/multibody/tree_joint.h"
#include "kernel/solver/contact_solver.h"
#include "kernel/solver/friction_axes.h"
#include "kernel/solver/tree_contacts.h"

namespace rubble {

// Fills the rows of one contact.
class TreeContacts::Builder {
 public:
  Builder(TreeContacts& all, const std::vector<Body>& bodies,
          const std::vector<std::int32_t>& number, const std::vector<float>& share)
      : all_(all), bodies_(bodies), number_(number), share_(share) {}

  void add(const SolverSettings& settings, const Contact& contact, std::int32_t index) {
    Item item;
    item.contact = index;
    item.friction = double(contact.friction);
    item.normal = Vec3(contact.normal);
    a_ = contact.body_a;
    b_ = contact.body_b;
    item.sides[0] = side_of(a_);
    item.sides[1] = side_of(b_);
    same_tree_ = item.sides[0].tree >= 0 && item.sides[0].tree == item.sides[1].tree;
    if (same_tree_) item.sides[1] = {};
    item.first_row = all_.rows_.size();
    item.rows = contact.count;
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      NormalRow n;
      n.row = make_row(item, item.normal, Vec3(p.from_a), Vec3(p.from_b));
      n.row.impulse = n.carried = double(p.normal_impulse);
      n.gap = double(p.separation) - double(settings.rest_gap);
      n.push_mass = all_.calc_push_mass(n.row, item);
      all_.rows_.push_back(n);
      item.middle_a += Vec3(p.from_a);
      item.middle_b += Vec3(p.from_b);
    }
    add_friction(item, contact);
    all_.items_.push_back(item);
  }

 private:
  Side side_of(std::int32_t index) const {
    Side side;
    if (index == kGround || !bodies_[std::size_t(index)].awake) return side;
    const Body& body = bodies_[std::size_t(index)];
    if (body.tree >= 0) {
      side.tree = body.tree;
      const TreeMotion& motion = (*all_.trees_.motions)[std::size_t(body.tree)];
      side.size = motion.size();
      side.push_weight = motion.tree().mass;
    } else {
      side.number = number_[std::size_t(index)];
      side.size = 6;
      side.push_weight = body.mass / double(share_[std::size_t(side.number)]);
    }
    return side;
  }

  void add_friction(Item& item, const Contact& contact) {
    const double part = 1.0 / contact.count;
    item.middle_a *= part;
    item.middle_b *= part;
    const Vec3& n = item.normal;
    item.tangents[0] =
        normalized(cross(n, std::abs(n.x) < 0.57735 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    item.tangents[1] = cross(n, item.tangents[0]);
    for (int t = 0; t < 2; ++t) {
      item.slide[t] = make_row(item, item.tangents[t], item.middle_a, item.middle_b);
    }
    all_.uncouple_friction(item);
    for (int t = 0; t < 2; ++t) {
      item.slide[t].impulse = dot(item.tangents[t], Vec3(contact.friction_impulse));
    }
    for (int i = 0; i < contact.count; ++i) {
      item.radius += part * norm(Vec3(contact.points[i].from_a) - item.middle_a);
    }
    item.twist = make_row(item, n, {}, {}, true);
    if (contact.count < 2) item.twist.mass = 0;
    item.twist.impulse = double(contact.twist_impulse);
  }

  // A row along `direction`, or about it where it turns.
  Row make_row(const Item& item, const Vec3& direction, const Vec3& from_a, const Vec3& from_b,
               bool turns = false) {
    Row row;
    row.first = all_.coefficients_.size();
    all_.coefficients_.resize(row.first + 2 * std::size_t(item.sides[0].size + item.sides[1].size));
    double* at = all_.coefficients_.data() + row.first;
    fill(item.sides[0], a_, direction * -1.0, from_a, turns, at);
    if (same_tree_) {
      fill(item.sides[0], b_, direction, from_b, turns, at);
    } else {
      fill(item.sides[1], b_, direction, from_b, turns, at + 2 * item.sides[0].size);
    }
    all_.finish_row(row, item);
    return row;
  }

  void fill(const Side& side, std::int32_t index, const Vec3& direction, const Vec3& from,
            bool turns, double* at) {
    const Vec3 torque = turns ? direction : cross(from, direction);
    const Vec3 force = turns ? Vec3{} : direction;
    if (side.tree >= 0) {
      TreeMotion& motion = (*all_.trees_.motions)[std::size_t(side.tree)];
      motion.add_row(bodies_[std::size_t(index)].link, torque, force, at, at + side.size);
    } else if (side.number >= 0) {
      const Body& body = bodies_[std::size_t(index)];
      const double share = double(share_[std::size_t(side.number)]);
      const Mat3f& m = body.inverse_inertia;
      const Mat3 inverse{{Vec3(m.rows[0]), Vec3(m.rows[1]), Vec3(m.rows[2])}};
      const Vec3 turn = inverse * torque * share, shift = force * (share / body.mass);
      for (int i = 0; i < 3; ++i) {
        at[i] = force[i], at[3 + i] = torque[i];
        at[6 + i] = shift[i], at[9 + i] = turn[i];
      }
    }
  }

  TreeContacts& all_;
  const std::vector<Body>& bodies_;
  const std::vector<std::int32_t>& number_;
  const std::vector<float>& share_;
  std::int32_t a_ = 0, b_ = 0;
  bool same_tree_ = false;
};

void TreeContacts::finish_row(Row& row, const Item& item) const {
  double sum = 0;
  const double* at = coefficients_.data() + row.first;
  for (const Side& side : item.sides) {
    for (int k = 0; k < side.size; ++k) sum += at[k] * at[side.size + k];
    at += 2 * side.size;
  }
  row.mass = sum > 0 ? 1 / sum : 0;
}

// Turns the tangents and their rows such that neither row feels the other's impulse.
void TreeContacts::uncouple_friction(Item& item) {
  double k[3] = {};  // first with itself, with the second, and the second with itself
  double* first = coefficients_.data() + item.slide[0].first;
  double* second = coefficients_.data() + item.slide[1].first;
  std::size_t at = 0;
  for (const Side& side : item.sides) {
    for (int i = 0; i < side.size; ++i, ++at) {
      const std::size_t turned = at + std::size_t(side.size);
      k[0] += first[at] * first[turned];
      k[1] += first[at] * second[turned];
      k[2] += second[at] * second[turned];
    }
    at += std::size_t(side.size);
  }
  const PlaneTurn<double> turn = find_friction_axes(k[0], k[1], k[2]);
  turn.apply(item.tangents[0], item.tangents[1]);
  for (std::size_t i = 0; i < at; ++i) turn.apply(first[i], second[i]);
  for (Row& row : item.slide) finish_row(row, item);
}

// Free pieces count as equally heavy, as in the push rows of other contacts; trees as a whole too.
double TreeContacts::calc_push_mass(const Row& row, const Item& item) const {
  double sum = 0;
  const double* at = coefficients_.data() + row.first;
  for (const Side& side : item.sides) {
    for (int k = 0; k < side.size; ++k) sum += at[k] * at[side.size + k] * side.push_weight;
    at += 2 * side.size;
  }
  return sum > 0 ? 1 / sum : 0;
}

void TreeContacts::add_stops(std::int32_t tree) {
  TreeMotion& motion = (*trees_.motions)[std::size_t(tree)];
  const std::size_t n = std::size_t(motion.size());
  for (const TreeLink& link : motion.tree().links) {
    JointStop stops[2];
    const int count = find_stops(link, motion.state().q.data(), motion.stop_margin(link), stops);
    for (int i = 0; i < count; ++i) {
      Item item;
      item.sides[0] = {tree, -1, int(n), motion.tree().mass};
      item.first_row = rows_.size();
      item.rows = 1;
      NormalRow row;
      row.row.first = coefficients_.size();
      coefficients_.resize(row.row.first + 2 * n);
      double* at = coefficients_.data() + row.row.first;
      for (int k = 0; k < speed_count(link.mobility); ++k) {
        at[link.first_u + k] = at[n + std::size_t(link.first_u + k)] = stops[i].direction[k];
      }
      motion.solve(at + n);
      finish_row(row.row, item);
      row.gap = stops[i].gap;
      row.push_mass = calc_push_mass(row.row, item);
      rows_.push_back(row);
      items_.push_back(item);
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
  coefficients_.clear();
  const double h = double(settings.step) / settings.substeps;
  for (std::int32_t tree : trees_.trees) {
    (*trees_.motions)[std::size_t(tree)].begin_substeps(h);
    add_stops(tree);
  }
  Builder builder(*this, bodies, number, share);
  for (std::int32_t index : order) builder.add(settings, contacts[std::size_t(index)], index);
}

}  // namespace rubble
