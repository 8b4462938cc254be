#include "kernel/multibody/simbody_build.h"

#include "kernel/base/hash.h"
#include "kernel/multibody/simbody_trees.h"

namespace rubble {
namespace {

// Of Debian 12's x86-64 Simbody 3.7.
constexpr std::uint64_t kReference = 0x02a71f0a95bebe65;

// Numbers between -1 and 1 with all their digits, from integers alone.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(std::int64_t(state_) >> 11) / 4503599627370496.0;
  }
  Vec3 vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  Quat rotation() {
    const double w = 2 + next();
    const Vec3 v = vector();
    return normalized(Quat{w, v.x, v.y, v.z});
  }

 private:
  std::uint64_t state_ = 1;
};

std::uint64_t hash_known_tree() {
  constexpr Mobility kKinds[] = {Mobility::hinge, Mobility::ball, Mobility::slider, Mobility::weld};
  Numbers numbers;
  Tree tree;
  std::vector<Body> bodies;
  TreeState state;
  for (int i = 0; i < 24; ++i) {
    Body body;
    body.mass = 2 + numbers.next();
    const double x = 0.5 + 0.2 * numbers.next(), y = 0.5 + 0.2 * numbers.next();
    body.inertia = Mat3::diagonal({y * y + 0.1, x * x + 0.1, x * x + y * y}) * (body.mass / 12);
    bodies.push_back(body);
    TreeLink link;
    link.body = i;
    if (i > 0) {
      link.parent = i - 1 - (i % 3 == 0 ? 1 : 0);
      link.mobility = kKinds[i % 4];
      link.parent_from_joint.rotation = numbers.rotation();
      link.parent_from_joint.translation = numbers.vector();
      link.link_from_joint.rotation = numbers.rotation();
      link.link_from_joint.translation = numbers.vector();
    }
    tree.mass += body.mass;
    tree.links.push_back(link);
  }
  number_coordinates(tree);
  for (int k = 0; k < tree.q_count; ++k) state.q.push_back(numbers.next());
  for (int k = 0; k < tree.u_count; ++k) state.u.push_back(numbers.next());
  for (const TreeLink& link : tree.links) {
    if (coordinate_count(link.mobility) < 4) continue;
    const Quat r = numbers.rotation();
    double* q = &state.q[std::size_t(link.first_q)];
    q[0] = r.w, q[1] = r.x, q[2] = r.y, q[3] = r.z;
  }
  SimbodyTree simbody(tree, bodies);
  simbody.set_state(state);
  StateHash hash;
  for (const LinkPose& link : simbody.pose().links) {
    for (int i = 0; i < 3; ++i) hash.add(link.centre[i]), hash.add(link.inertia.rows[i].x);
  }
  for (const Spatial& axis : simbody.pose().axes) {
    for (int i = 0; i < 6; ++i) hash.add(axis[i]);
  }
  std::vector<double> forces, accelerations;
  simbody.calc_forces(9.81, forces);
  simbody.multiply_by_inverse_mass(forces, accelerations);
  for (double force : forces) hash.add(force);
  for (double acceleration : accelerations) hash.add(acceleration);
  return hash.digest();
}

}  // namespace

bool simbody_has_reference_bits() {
  static const bool has = hash_known_tree() == kReference;
  return has;
}

}  // namespace rubble
