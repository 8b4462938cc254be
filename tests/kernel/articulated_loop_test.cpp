// Loops of joints, and assemblies that are none.
#include <gtest/gtest.h>

#include <cmath>

#include "articulated_scene.h"
#include "kernel/base/error.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace articulated_loop_test {

using testing::awake_options;
using testing::box_type;
using testing::hung;
using testing::joint_of;
using testing::kAboutY;
using testing::kG;
using testing::make_chain;
using testing::make_world;
using testing::measure_period;
using testing::run;
using testing::turned;

std::string error_of(const AssemblyType& assembly) {
  try {
    World({box_type("block", 0.1, 0.1, 0.1), box_type("bar", 1, 0.1, 0.1)}, {}, {assembly});
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "";
}

// Two rods of length 1 hang from a fixed block and carry a third between them; the last joint closes
// the loop. The rods lean by `angle`.
AssemblyType make_parallelogram(double angle, double break_force = kNever) {
  AssemblyType frame;
  const Quat lean = turned({0, 1, 0}, angle), upright = turned({0, 1, 0}, 1.5707963267948966);
  const Vec3 down = lean.rotate({0, 0, -1}), across{1, 0, 0};
  frame.links = {{0, {}, 1},
                 {1, {lean * upright, down * 0.5}, 1},
                 {1, {{}, down + across * 0.5}, 1},
                 {1, {lean * upright, across + down * 0.5}, 1}};
  const Vec3 places[4] = {{}, down, down + across, across};
  for (int i = 0; i < 4; ++i) {
    JointType joint = joint_of(JointKind::hinge);
    joint.parent = i < 3 ? i : 0;
    joint.child = i < 3 ? i + 1 : 3;
    joint.assembly_from_joint = {kAboutY, places[i]};
    if (i == 3) joint.break_force = break_force;
    frame.joints.push_back(joint);
  }
  return frame;
}

// w^2 = 2 g m l / (2 m l^2 / 3 + m l^2) = 1.2 g / l: the rod in the middle does not turn.
TEST(Articulated, ALoopOfHingesSwingsAsAParallelogram) {
  World world = make_world(make_parallelogram(0.05), 1, awake_options());
  world.add({hung({0, 0, 5})});
  const double expected = 2 * 3.14159265358979 / std::sqrt(1.2 * kG);
  EXPECT_NEAR(measure_period(world, 1, 20), expected, 2e-3 * expected);
  const auto place = [&](int piece, double along) {
    return world.piece(piece).world_from_body * Vec3{along, 0, 0};
  };
  EXPECT_LT(distance(place(3, -0.5), Vec3{1, 0, 5}), 1e-4);  // the joint of the loop
  const Vec3 level = place(2, 0.5) - place(2, -0.5);
  EXPECT_NEAR(level.z, 0, 1e-4);
  EXPECT_EQ(world.joints().size(), 4u);
}

// It may swing wide, and must not gain energy by that.
TEST(Articulated, ALoopNeverGainsEnergy) {
  World world = make_world(make_parallelogram(1.2), 1, awake_options());
  world.add({hung({0, 0, 5})});
  const double start = world.diagnostics().potential_energy(), lowest = start - 2 * world.mass(1) * kG *
                                                                      (1 - std::cos(1.2));
  double last = start;
  for (int i = 0; i < 600; ++i) {
    world.step();
    last = world.diagnostics().kinetic_energy() + world.diagnostics().potential_energy();
    EXPECT_LT(last, start + 0.01 * (start - lowest)) << "step " << i;
  }
  // Each step leaves the circle by its tangent; closing the loop again costs 3 % a second.
  EXPECT_GT(last - lowest, 0.6 * (start - lowest));
}

// At rest the joint of the loop carries its rod and half of the one in the middle.
TEST(Articulated, ALoopBreaksAtItsLoad) {
  const double weight = 1.5 * 2400 * 0.02 * 0.02 * kG;
  for (double share : {1.02, 0.98}) {
    World world = make_world(make_parallelogram(0, share * weight), 1, awake_options());
    world.add({hung({0, 0, 5})});
    run(world, 1);
    EXPECT_EQ(world.joints().size(), share > 1 ? 4u : 3u);
    EXPECT_EQ(world.piece(3).world_from_body.translation.z < 4.4, share < 1);
  }
}

TEST(Articulated, ALoopHasNoSpring) {
  AssemblyType frame = make_parallelogram(0);
  frame.joints[3].stiffness = 3;
  EXPECT_NE(error_of(frame).find("joints[3].stiffness"), std::string::npos) << error_of(frame);
}

TEST(Articulated, RefusesWhatIsNoTree) {
  const AssemblyType good = make_chain(2, 1, true, joint_of(JointKind::ball));
  EXPECT_EQ(error_of(good), "");
  AssemblyType bad = good;
  bad.joints.pop_back();
  EXPECT_NE(error_of(bad).find("assemblies[0].links[2]"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints[1].parent = 2;
  EXPECT_NE(error_of(bad).find("listed before"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints[1].child = 1;
  bad.joints[1].parent = 0;
  EXPECT_NE(error_of(bad).find("child of one joint"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints.push_back(bad.joints[1]);
  bad.joints.back().parent = bad.joints.back().child;
  EXPECT_NE(error_of(bad).find("two links"), std::string::npos) << error_of(bad);
  bad = good;
  bad.links[1].type = 7;
  EXPECT_NE(error_of(bad).find("no such type"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints[0].stiffness = -1;
  EXPECT_NE(error_of(bad).find("joints[0].stiffness"), std::string::npos) << error_of(bad);
}

}  // namespace articulated_loop_test
}  // namespace rubble
