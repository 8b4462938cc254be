// A joint's spring against its energy, and matrices of six rows.
#include <gtest/gtest.h>

#include "kernel/base/random.h"
#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/tree_motion.h"

namespace rubble {
namespace tree_joint_test {

TEST(Spatial, InvertsWhatIsPositiveDefinite) {
  RandomStream random(7, "matrix");
  SpatialMatrix matrix;
  for (int i = 0; i < 8; ++i) {
    double parts[6];
    for (double& part : parts) part = random.uniform(-1, 1);
    const Spatial v{{parts[0], parts[1], parts[2]}, {parts[3], parts[4], parts[5]}};
    matrix.add_product(v, v, 1 + i);
  }
  const SpatialMatrix inverse = invert(matrix);
  for (int c = 0; c < 6; ++c) {
    const Spatial column = inverse * matrix.columns[c];
    for (int r = 0; r < 6; ++r) EXPECT_NEAR(column[r], r == c, 1e-9);
  }
}

// A ball's spring: the torque is the slope of the energy; creep takes energy away.
TEST(TreeJoint, SpringsFollowTheirEnergy) {
  TreeLink link;
  const Joint& ball = joint_of(Mobility::ball);
  link.mobility = Mobility::ball;
  link.stiffness = 50;
  RandomStream random(3, "spring");
  for (int i = 0; i < 20; ++i) {
    const Quat r = random.rotation();
    link.rest_rotation = random.rotation();
    const double q[4] = {r.w, r.x, r.y, r.z};
    double torque[3] = {};
    ball.add_spring(link, q, torque);
    for (int axis = 0; axis < 3; ++axis) {
      double energy[2];
      for (int side = 0; side < 2; ++side) {
        double moved[4] = {q[0], q[1], q[2], q[3]}, by[3] = {};
        by[axis] = side == 0 ? -1e-5 : 1e-5;
        ball.move(by, moved);
        energy[side] = ball.calc_spring_energy(link, moved);
      }
      EXPECT_NEAR(torque[axis], -(energy[1] - energy[0]) / 2e-5, 1e-4);
    }
    link.yield = 20;
    const double before = ball.calc_spring_energy(link, q);
    ball.creep(link, q);
    EXPECT_LE(ball.calc_spring_energy(link, q), before * (1 + 1e-12));
    double after[3] = {};
    ball.add_spring(link, q, after);
    const double torque_after = norm(Vec3{after[0], after[1], after[2]});
    EXPECT_LE(torque_after, 20 * (1 + 1e-12));
    if (norm(Vec3{torque[0], torque[1], torque[2]}) > 20) {
      EXPECT_NEAR(torque_after, 20, 1e-9);
    }
    link.yield = kNever;
  }
}

}  // namespace tree_joint_test
}  // namespace rubble
