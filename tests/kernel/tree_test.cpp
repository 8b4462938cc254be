// The dynamics of trees against Simbody's own, which computes nothing else in this program.
#include "kernel/multibody/tree_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/random.h"
#include "kernel/multibody/simbody_trees.h"
#include "kernel/multibody/tree_joint.h"

namespace rubble {
namespace {

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

TEST(TreeDynamics, PosesAreSimbodys) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomTree t = make_tree(seed);
    SimbodyTrees simbody;
    simbody.add(t.tree, t.bodies, t.state);
    TreePose pose;
    pose.set(t.tree, t.bodies, t.state.q, {0.1, 0.2, 0.3});
    for (std::size_t i = 0; i < t.tree.links.size(); ++i) {
      const Pose theirs = simbody.calc_simbody_pose(0, int(i));
      EXPECT_LT(distance(pose.world_from_com[i].translation, theirs.translation), 1e-12);
      const Quat turn = pose.world_from_com[i].rotation.conjugate() * theirs.rotation;
      EXPECT_LT(norm(Vec3{turn.x, turn.y, turn.z}), 1e-12) << "seed " << seed << ", link " << i;
    }
    const TreeState back = simbody.state(0);
    EXPECT_EQ(back.q, t.state.q);
    EXPECT_EQ(back.u, t.state.u);
  }
}

// What a very short step changes, against what Simbody says that it changes: gravity, inertia,
// centrifugal and gyroscopic terms.
TEST(TreeDynamics, AccelerationsAreSimbodys) {
  constexpr double kStep = 1e-6;
  double largest = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomTree t = make_tree(seed);
    SimbodyTrees simbody;
    simbody.add(t.tree, t.bodies, t.state);
    const std::vector<double> theirs = simbody.calc_simbody_accelerations(0, kGravity);
    double scale = 0;
    for (double a : theirs) scale = std::max(scale, std::abs(a));
    TreeMotion motion;
    motion.begin(t.tree, t.bodies, t.state, kGravity, kStep);
    motion.move_freely();
    for (std::size_t k = 0; k < theirs.size(); ++k) {
      const double ours = (motion.state().u[k] - t.state.u[k]) / kStep;
      EXPECT_NEAR(ours, theirs[k], 3e-5 * scale) << "seed " << seed << ", speed " << k;
      largest = std::max(largest, std::abs(ours));
    }
  }
  EXPECT_GT(largest, 10);  // they do move
}

// The midpoint rule: halving the step divides the error by four.
TEST(TreeDynamics, StepsAreOfSecondOrder) {
  const auto end_of = [](int steps) {
    RandomTree t = make_tree(4);
    for (double& u : t.state.u) u *= 0.5;
    for (int i = 0; i < steps; ++i) {
      TreeMotion motion;
      t.bodies[0].world_from_com.translation = {};
      motion.begin(t.tree, t.bodies, t.state, kGravity, 0.2 / steps);
      motion.move_freely();
      t.state = motion.state();
    }
    return t.state.q;
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

TEST(TreeDynamics, AFreeTreeKeepsItsMomentum) {
  for (std::uint64_t seed : {2, 6, 12, 18}) {
    RandomTree t = make_tree(seed);
    for (double& u : t.state.u) u *= 0.7;
    const auto momentum = [&t] {
      TreePose pose;
      std::vector<Spatial> motions, momenta;
      pose.set(t.tree, t.bodies, t.state.q, {});
      calc_motions(t.tree, pose, t.state.u, motions);
      calc_momenta(t.tree, t.bodies, pose, motions, momenta);
      Spatial sum;
      double energy = 0;
      for (std::size_t i = 0; i < momenta.size(); ++i) {
        sum += momenta[i], energy += 0.5 * dot(momenta[i], motions[i]);
      }
      return std::pair(sum, energy);
    };
    const auto [before, energy] = momentum();
    double last = energy;
    for (int i = 0; i < 60; ++i) {
      TreeMotion motion;
      motion.begin(t.tree, t.bodies, t.state, 0, 1.0 / 60);
      motion.move_freely();
      t.state = motion.state();
      const double now = momentum().second;
      EXPECT_LE(now, last * (1 + 1e-12));
      last = now;
    }
    const Spatial after = momentum().first;
    EXPECT_LT(norm(after.linear - before.linear), 1e-3 * norm(before.linear)) << seed;
    EXPECT_LT(norm(after.angular - before.angular), 0.02 * norm(before.angular)) << seed;
    EXPECT_GT(last, 0.95 * energy) << seed;
  }
}

TEST(Cholesky, SolvesAndRefuses) {
  RandomStream random(7, "matrix");
  constexpr int n = 20;
  SymmetricMatrix matrix;
  matrix.resize(n);
  double factors[n][n];
  for (auto& row : factors) {
    for (double& x : row) x = random.uniform(-1, 1);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k < n; ++k) matrix.at(i, j) += factors[i][k] * factors[j][k];
    }
  }
  Cholesky cholesky;
  ASSERT_TRUE(cholesky.factor(matrix));
  double x[n], b[n] = {};
  for (double& v : x) v = random.uniform(-1, 1);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) b[i] += (i >= j ? matrix.at(i, j) : matrix.at(j, i)) * x[j];
  }
  cholesky.solve(b);
  for (int i = 0; i < n; ++i) EXPECT_NEAR(b[i], x[i], 1e-7);
  matrix.at(3, 3) = -1;
  EXPECT_FALSE(cholesky.factor(matrix));
}

// A ball's spring: the torque is the slope of the energy; creep takes energy away.
TEST(TreeJoint, SpringsFollowTheirEnergy) {
  TreeLink link;
  link.mobility = Mobility::ball;
  link.stiffness = 50;
  RandomStream random(3, "spring");
  for (int i = 0; i < 20; ++i) {
    const Quat r = random.rotation();
    link.rest_rotation = random.rotation();
    const double q[4] = {r.w, r.x, r.y, r.z};
    double torque[3] = {};
    add_spring(link, q, torque);
    for (int axis = 0; axis < 3; ++axis) {
      double energy[2];
      for (int side = 0; side < 2; ++side) {
        double moved[4] = {q[0], q[1], q[2], q[3]}, by[3] = {};
        by[axis] = side == 0 ? -1e-5 : 1e-5;
        move_joint(link, by, moved);
        energy[side] = calc_spring_energy(link, moved);
      }
      EXPECT_NEAR(torque[axis], -(energy[1] - energy[0]) / 2e-5, 1e-4);
    }
    link.yield = 20;
    const double before = calc_spring_energy(link, q);
    creep(link, q);
    EXPECT_LE(calc_spring_energy(link, q), before * (1 + 1e-12));
    double after[3] = {};
    add_spring(link, q, after);
    const double torque_after = norm(Vec3{after[0], after[1], after[2]});
    EXPECT_LE(torque_after, 20 * (1 + 1e-12));
    if (norm(Vec3{torque[0], torque[1], torque[2]}) > 20) {
      EXPECT_NEAR(torque_after, 20, 1e-9);
    }
    link.yield = kNever;
  }
}

}  // namespace
}  // namespace rubble
