// The dynamics of trees: what is summed from Simbody's figures against what Simbody makes of them,
// and our stepping against Simbody's own integrator.
#include "kernel/multibody/tree_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/random.h"
#include "kernel/multibody/simbody_trees.h"
#include "simbody_judge.h"

namespace rubble {
namespace tree_test {

constexpr double kGravity = 9.81;

struct RandomTree {
  Tree tree;
  std::vector<Body> bodies;
  TreeState state;
};

Vec3 random_vector(RandomStream& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  const double z = random.uniform(-size, size);
  return {x, y, z};
}

Pose random_pose(RandomStream& random, double size) {
  const Quat rotation = random.rotation();
  return {rotation, random_vector(random, size)};
}

Body random_body(RandomStream& random) {
  Body body;
  body.mass = random.uniform(0.5, 50);
  // Of a box, so that the moments are those of a solid.
  const double x = random.uniform(0.1, 1);
  const double y = random.uniform(0.1, 1);
  const double z = random.uniform(0.1, 1);
  const Mat3 own = Mat3::diagonal({y * y + z * z, x * x + z * z, x * x + y * y}) * (body.mass / 12);
  const Mat3 r = random.rotation().matrix();
  body.inertia = r * own * r.transposed();
  return body;
}

RandomTree make_tree(std::uint64_t seed) {
  RandomStream random(seed, "tree");
  RandomTree result;
  const int count = 2 + int(random.uniform(0, 7));
  for (int i = 0; i < count; ++i) {
    TreeLink link;
    link.body = i;
    result.bodies.push_back(random_body(random));
    if (i == 0) {
      link.mobility = seed % 2 == 0 ? Mobility::free : Mobility::fixed;
      if (link.mobility == Mobility::fixed) result.bodies[0].mass = 0;
    } else {
      link.parent = std::int32_t(random.uniform(0, i));
      link.mobility = Mobility(2 + int(random.uniform(0, 4)));
      link.parent_from_joint = random_pose(random, 1);
      link.link_from_joint = random_pose(random, 1);
    }
    result.tree.mass += result.bodies.back().mass;
    result.tree.links.push_back(link);
  }
  result.tree.root = random_pose(random, 3);
  number_coordinates(result.tree);
  result.state.q.resize(std::size_t(result.tree.q_count));
  result.state.u.resize(std::size_t(result.tree.u_count));
  for (double& q : result.state.q) q = random.uniform(-1, 1);
  for (double& u : result.state.u) u = random.uniform(-3, 3);
  for (const TreeLink& link : result.tree.links) {
    if (coordinate_count(link.mobility) < 4) continue;
    const Quat r = random.rotation();
    double* q = &result.state.q[std::size_t(link.first_q)];
    q[0] = r.w, q[1] = r.x, q[2] = r.y, q[3] = r.z;
  }
  result.bodies[0].world_from_com = result.tree.root;
  return result;
}

// The joint's own transform, as tree.h defines it.
Pose joint_pose(const TreeLink& link, const double* q) {
  switch (link.mobility) {
    case Mobility::free:
      return {{q[0], q[1], q[2], q[3]}, {q[4], q[5], q[6]}};
    case Mobility::ball:
      return {{q[0], q[1], q[2], q[3]}, {}};
    case Mobility::hinge:
      return {{std::cos(0.5 * q[0]), 0, 0, std::sin(0.5 * q[0])}, {}};
    case Mobility::slider:
      return {{}, {q[0], 0, 0}};
    case Mobility::fixed:
    case Mobility::weld:
      break;
  }
  return {};
}

TEST(TreeDynamics, PosesAreWhatTheCoordinatesSay) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomTree t = make_tree(seed);
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    std::vector<Pose> found, expected;
    simbody.calc_world_from_links(found);
    for (std::size_t i = 0; i < t.tree.links.size(); ++i) {
      const TreeLink& link = t.tree.links[i];
      const Pose joint = joint_pose(link, t.state.q.data() + link.first_q);
      expected.push_back(link.mobility == Mobility::fixed ? t.tree.root
                         : link.parent < 0
                             ? joint
                             : expected[std::size_t(link.parent)] * link.parent_from_joint *
                                   joint * link.link_from_joint.inverse());
      EXPECT_LT(distance(found[i].translation, expected[i].translation), 1e-12);
      const Quat turn = found[i].rotation.conjugate() * expected[i].rotation;
      EXPECT_LT(norm(Vec3{turn.x, turn.y, turn.z}), 1e-12) << "seed " << seed << ", link " << i;
    }
    EXPECT_EQ(simbody.state().q, t.state.q);
    EXPECT_EQ(simbody.state().u, t.state.u);
  }
}

// Our free root is a Translation with a Ball and our hinge a Custom mobilizer: they move as
// Simbody's Free and Pin do.
TEST(TreeDynamics, AccelerationsAreThoseOfSimbodysOwnMobilizers) {
  double largest = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomTree t = make_tree(seed);
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    simbody.pose();
    std::vector<double> forces, found;
    simbody.calc_forces(kGravity, forces);
    simbody.multiply_by_inverse_mass(forces, found);
    const std::vector<double> expected =
        testing::accelerate_with_simbody(t.tree, t.bodies, t.state, kGravity);
    ASSERT_EQ(found.size(), expected.size());
    double scale = 1;
    for (double a : expected) scale = std::max(scale, std::abs(a));
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k], expected[k], 1e-9 * scale) << "seed " << seed << ", speed " << k;
    }
    largest = std::max(largest, scale);
  }
  EXPECT_GT(largest, 10);  // they do move
}

std::vector<double> random_numbers(RandomStream& random, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < count; ++k) numbers.push_back(random.uniform(-1, 1));
  return numbers;
}

// Without springs the factors must give Simbody's M^-1.
TEST(ArticulatedInertia, IsSimbodysWithoutADiagonal) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomTree t = make_tree(seed);
    RandomStream random(seed, "forces");
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    ArticulatedInertia inertia;
    inertia.factor(t.tree, simbody.pose(), std::vector<double>(t.tree.links.size(), 0));
    const std::vector<double> forces = random_numbers(random, t.state.u.size());
    std::vector<double> expected, found;
    simbody.multiply_by_inverse_mass(forces, expected);
    std::vector<Spatial> none(t.tree.links.size()), changes;
    inertia.solve(none, forces, changes);
    calc_speeds(t.tree, simbody.pose(), changes, found);
    double scale = 0;
    for (double a : expected) scale = std::max(scale, std::abs(a));
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k], expected[k], 1e-10 * scale) << "seed " << seed << ", speed " << k;
    }
  }
}

// x solves (M + D) x = f where x = M^-1 (f - D x).
TEST(ArticulatedInertia, CarriesADiagonal) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomTree t = make_tree(seed);
    RandomStream random(seed, "diagonal");
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    std::vector<double> diagonal;
    for (const TreeLink& link : t.tree.links) {
      diagonal.push_back(link.parent < 0 ? 0 : random.uniform(0, 100));
    }
    ArticulatedInertia inertia;
    inertia.factor(t.tree, simbody.pose(), diagonal);
    std::vector<double> forces = random_numbers(random, t.state.u.size()), x, back;
    std::vector<Spatial> none(t.tree.links.size()), changes;
    inertia.solve(none, forces, changes);
    calc_speeds(t.tree, simbody.pose(), changes, x);
    for (std::size_t i = 1; i < t.tree.links.size(); ++i) {
      const TreeLink& link = t.tree.links[i];
      for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
        forces[std::size_t(k)] -= diagonal[i] * x[std::size_t(k)];
      }
    }
    simbody.multiply_by_inverse_mass(forces, back);
    double scale = 0;
    for (double a : x) scale = std::max(scale, std::abs(a));
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_NEAR(back[k], x[k], 1e-8 * scale) << "seed " << seed << ", speed " << k;
    }
  }
}

// One impulse after another on links in any order, against all of them at once.
TEST(LinkMotions, FollowImpulsesOnAnyLink) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomTree t = make_tree(seed);
    RandomStream random(seed, "impulses");
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    const std::size_t count = t.tree.links.size();
    ArticulatedInertia inertia;
    inertia.factor(t.tree, simbody.pose(), std::vector<double>(count, 0.5));
    std::vector<Spatial> motions, all(count), changes;
    calc_motions(t.tree, simbody.pose(), t.state.u, motions);
    LinkMotions found;
    found.begin(inertia, motions);
    const std::vector<double> none(t.state.u.size(), 0);
    for (int round = 0; round < 30; ++round) {
      const auto link = std::int32_t(random.uniform(0, double(count)));
      const Vec3 moment = random_vector(random, 1);
      const Spatial impulse{moment, random_vector(random, 1)};
      // What the link has before: by all impulses so far.
      std::vector<Spatial> so_far = all;
      inertia.solve(so_far, none, changes);
      const Spatial wrong = found.focus_on(link) - motions[std::size_t(link)] -
                            changes[std::size_t(link)];
      EXPECT_LT(dot(wrong, wrong), 1e-16) << "seed " << seed << ", round " << round;
      found.apply(impulse);
      all[std::size_t(link)] += impulse;
    }
    found.settle();
    std::vector<Spatial> used = all;
    inertia.solve(used, none, changes);
    for (std::size_t i = 0; i < count; ++i) {
      const Spatial wrong = found.motion(std::int32_t(i)) - motions[i] - changes[i];
      EXPECT_LT(dot(wrong, wrong), 1e-16) << "seed " << seed << ", link " << i;
    }
    const auto a = std::int32_t(random.uniform(0, double(count)));
    const auto b = std::int32_t(random.uniform(0, double(count)));
    std::vector<Spatial> one(count);
    one[std::size_t(b)] = {{1, 2, 3}, {4, 5, 6}};
    const Spatial crossed = inertia.calc_cross_response(a, b) * one[std::size_t(b)];
    inertia.solve(one, none, changes);
    const Spatial wrong = crossed - changes[std::size_t(a)];
    EXPECT_LT(dot(wrong, wrong), 1e-16 * (1 + dot(crossed, crossed)));
  }
}

struct Moved {
  TreeState state;
  std::vector<Pose> poses;
};

// Steps of 1/60 s, or others.
Moved step_freely(RandomTree t, double gravity, int steps, double step) {
  SimbodyTree simbody(t.tree, t.bodies);
  simbody.set_state(t.state);
  Moved moved;
  for (int i = 0; i < steps; ++i) {
    TreeMotion motion;
    motion.begin(t.tree, simbody, gravity, step);
    motion.move_freely();
    moved.poses = motion.world_from_links();
  }
  moved.state = simbody.state();
  return moved;
}

// Slabs of 1.2 x 0.6 x 0.1 m in a row on crossed hinges or balls, from a fixed end or freely.
RandomTree make_slab_chain(Mobility mobility, bool fixed, int count) {
  RandomTree t;
  const double mass = 2400 * 1.2 * 0.6 * 0.1;
  const Quat across{std::sqrt(0.5), -std::sqrt(0.5), 0, 0};  // takes Z to Y
  for (int i = 0; i < count; ++i) {
    Body body;
    body.mass = mass;
    body.inertia = Mat3::diagonal({0.36 + 0.01, 1.44 + 0.01, 1.44 + 0.36}) * (mass / 12);
    TreeLink link;
    link.body = i;
    if (i == 0) {
      link.mobility = fixed ? Mobility::fixed : Mobility::free;
      if (fixed) body.mass = 0;
    } else {
      link.parent = i - 1;
      link.mobility = mobility;
      const Quat turn = i % 2 == 1 ? across : Quat{};
      link.parent_from_joint = {turn, {0.62, 0, 0}};
      link.link_from_joint = {turn, {-0.62, 0, 0}};
    }
    t.tree.mass += body.mass;
    t.bodies.push_back(body);
    t.tree.links.push_back(link);
  }
  t.tree.root = {{}, {0, 0, 5}};
  number_coordinates(t.tree);
  t.state.q.assign(std::size_t(t.tree.q_count), 0);
  t.state.u.assign(std::size_t(t.tree.u_count), 0);
  for (const TreeLink& link : t.tree.links) {
    if (coordinate_count(link.mobility) >= 4) t.state.q[std::size_t(link.first_q)] = 1;
  }
  if (!fixed) {
    t.state.q[6] = 5;
    for (std::size_t k = 0; k < t.state.u.size(); ++k) t.state.u[k] = k % 2 == 0 ? 0.7 : -0.4;
  }
  return t;
}

// Rounding must not grow along a chain: a first version of the factors lost a digit with each link.
TEST(ArticulatedInertia, KeepsItsDigitsInLongChains) {
  for (int count : {8, 32, 200}) {
    RandomTree t = make_slab_chain(Mobility::ball, false, count);
    RandomStream random(std::uint64_t(count), "bends");
    for (const TreeLink& link : t.tree.links) {
      if (link.parent < 0) continue;
      const Vec3 bend = random_vector(random, 0.2);
      double* q = &t.state.q[std::size_t(link.first_q)];
      const Quat r = normalized(Quat{1, bend.x, bend.y, bend.z});
      q[0] = r.w, q[1] = r.x, q[2] = r.y, q[3] = r.z;
    }
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    ArticulatedInertia inertia;
    inertia.factor(t.tree, simbody.pose(), std::vector<double>(t.tree.links.size(), 0));
    const std::vector<double> forces = random_numbers(random, t.state.u.size());
    std::vector<double> expected, found;
    simbody.multiply_by_inverse_mass(forces, expected);
    std::vector<Spatial> none(t.tree.links.size()), changes;
    inertia.solve(none, forces, changes);
    calc_speeds(t.tree, simbody.pose(), changes, found);
    double scale = 0, worst = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      scale = std::max(scale, std::abs(expected[k]));
      worst = std::max(worst, std::abs(found[k] - expected[k]));
    }
    EXPECT_LT(worst, 1e-7 * scale) << count << " links";
  }
}

// Chains that swing down from the horizontal, and that fall and writhe: after 1 s no link is more
// than 1 mm from where Simbody's own integrator has it, at steps of 1/60 s and 1/240 s.
TEST(TreeDynamics, AChainFollowsSimbodysIntegrator) {
  for (bool fixed : {true, false}) {
    for (Mobility mobility : {Mobility::hinge, Mobility::ball}) {
      const RandomTree t = make_slab_chain(mobility, fixed, 5);
      const std::vector<Pose> exact =
          testing::integrate_with_simbody(t.tree, t.bodies, t.state, kGravity, 1);
      const auto error_of = [&](int steps) {
        const Moved moved = step_freely(t, kGravity, steps, 1.0 / steps);
        double worst = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
          worst = std::max(worst, distance(moved.poses[i].translation, exact[i].translation));
        }
        return worst;
      };
      const double travelled = distance(exact.back().translation, {4 * 1.24, 0, 5});
      EXPECT_LT(error_of(60), 1e-3) << fixed << int(mobility);
      EXPECT_LT(error_of(240), 3e-4) << fixed << int(mobility);
      EXPECT_GT(travelled, 0.5);
    }
  }
}

// Halving the step divides the error by four.
TEST(TreeDynamics, StepsAreOfSecondOrder) {
  const auto end_of = [](int steps) {
    RandomTree t = make_tree(4);
    for (double& u : t.state.u) u *= 0.5;
    return step_freely(t, kGravity, steps, 0.2 / steps).state.q;
  };
  const std::vector<double> exact = end_of(4096), coarse = end_of(64), fine = end_of(128);
  double coarse_error = 0, fine_error = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    coarse_error = std::max(coarse_error, std::abs(coarse[k] - exact[k]));
    fine_error = std::max(fine_error, std::abs(fine[k] - exact[k]));
  }
  EXPECT_GT(coarse_error, 1e-9);
  EXPECT_LT(fine_error, coarse_error / 3);
}

TEST(TreeDynamics, AFreeTreeKeepsItsMomentumAndEnergy) {
  for (std::uint64_t seed : {2, 6, 12, 18}) {
    RandomTree t = make_tree(seed);
    SimbodyTree simbody(t.tree, t.bodies);
    simbody.set_state(t.state);
    const auto momentum = [&] {  // about the world's origin
      const TreePose& pose = simbody.pose();
      std::vector<Spatial> motions;
      calc_motions(t.tree, pose, simbody.state().u, motions);
      Spatial sum;
      double energy = 0;
      Vec3 first;
      for (std::size_t i = 0; i < motions.size(); ++i) {
        const Spatial p = pose.links[i].momentum(motions[i]);
        sum += p, energy += 0.5 * dot(p, motions[i]);
        first += (pose.reference + pose.links[i].centre) * pose.links[i].mass;
      }
      const Vec3 about = first * (1 / t.tree.mass) - pose.reference;
      sum = {sum.angular() - cross(about, sum.linear()), sum.linear()};
      return std::pair(sum, energy);
    };
    const auto [before, energy] = momentum();
    for (int i = 0; i < 60; ++i) {
      TreeMotion motion;
      motion.begin(t.tree, simbody, 0, 1.0 / 60);
      motion.move_freely();
      EXPECT_NEAR(momentum().second, energy, 1e-6 * energy) << seed << ", step " << i;
    }
    const Spatial after = momentum().first;
    EXPECT_LT(norm(after.linear() - before.linear()), 1e-10 * norm(before.linear())) << seed;
    EXPECT_LT(norm(after.angular() - before.angular()), 1e-10 * norm(before.angular())) << seed;
  }
}

}  // namespace tree_test
}  // namespace rubble
