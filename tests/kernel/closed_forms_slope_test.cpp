// Coulomb friction on ramps, and that it acts where the load is.
#include <gtest/gtest.h>

#include <cmath>

#include "closed_forms.h"

namespace rubble {
namespace closed_forms_slope_test {

using namespace testing;

constexpr double kGap = 0.001;  // between surfaces at the start; unit: m

// `block` at the upper end of a ramp of 60 m that goes down towards +X.
World make_ramp(PieceType block, double slope, double friction, double half_height) {
  PieceType ramp = box_type("ramp", 60, 6, 1);
  ramp.friction = block.friction = friction;
  World world({ramp, block}, awake_options());
  const Quat q = turned({0, 1, 0}, slope);
  world.add({at(0, {0, 0, 40}, q, true),
             at(1, Vec3{0, 0, 40} + q.rotate({-25, 0, 0.5 + half_height + kGap}), q)});
  return world;
}

TEST(ClosedFormSlope, SticksBelowTheAngleOfFriction) {
  for (int i = 2; i <= 9; ++i) {
    const double friction = 0.1 * i;
    World world =
        make_ramp(box_type("box", 0.4, 0.4, 0.1), std::atan(0.98 * friction), friction, 0.05);
    run(world, 0.5);
    const Vec3 start = world.piece(1).world_from_body.translation;
    run(world, 4);
    EXPECT_LT(distance(world.piece(1).world_from_body.translation, start), 0.001) << friction;
  }
}

// g (sin a - mu cos a) t^2 / 2, from rest, where the slope is 1.1 and 1.5 times the friction.
TEST(ClosedFormSlope, SlidesAboveTheAngleOfFriction) {
  for (int i = 2; i <= 9; ++i) {
    for (const double steepness : {1.1, 1.5}) {
      const double friction = 0.1 * i, slope = std::atan(steepness * friction), seconds = 2;
      World world = make_ramp(box_type("box", 0.4, 0.4, 0.1), slope, friction, 0.05);
      const Vec3 start = world.piece(1).world_from_body.translation;
      run(world, seconds);
      const double expected =
          0.5 * kG * (std::sin(slope) - friction * std::cos(slope)) * seconds * seconds;
      EXPECT_NEAR(distance(world.piece(1).world_from_body.translation, start), expected,
                  0.03 * expected)
          << "friction " << friction << ", slope " << slope;
    }
  }
}

// A box of 1 x 0.8 x 0.2 m whose mass is in its left half: half of its base carries next to
// nothing.
PieceType uneven_type() {
  PieceType type = box_type("uneven", 1, 0.8, 0.2);
  VolumeProperties volume;
  volume.volume = 1 * 0.8 * 0.2;
  volume.centre_of_mass = {0, 0.25, 0};
  volume.inertia = Mat3::diagonal({0.16 / 12 * (0.09 + 0.04), 0.16 / 12 * 1.04, 0.16 / 12 * 1.09});
  type.volume = volume;
  return type;
}

double yaw_of(const World& world, int piece, double slope) {
  const Quat q = turned({0, 1, 0}, slope).conjugate() * world.piece(piece).world_from_body.rotation;
  return 2 * std::atan2(q.z, q.w);
}

// All friction points up the slope, and the middle of the pressure is under the centre of mass:
// there is no torque about the normal, and it slides straight.
TEST(ClosedFormSlope, AnUnevenlyLoadedBoxSlidesStraight) {
  const double slope = 0.5, friction = 0.3, seconds = 2;
  World world = make_ramp(uneven_type(), slope, friction, 0.1);
  const Vec3 start = world.piece(1).world_from_body.translation;
  run(world, seconds);
  EXPECT_LT(std::abs(yaw_of(world, 1, slope)), 0.02);
  const Vec3 moved = world.piece(1).world_from_body.translation - start;
  const double expected =
      0.5 * kG * (std::sin(slope) - friction * std::cos(slope)) * seconds * seconds;
  EXPECT_NEAR(norm(moved), expected, 0.03 * expected);
  EXPECT_LT(std::abs(moved.y), 0.05);
}

TEST(ClosedFormSlope, AnUnevenlyLoadedBoxIsHeldWithoutTurning) {
  const double friction = 0.5, slope = std::atan(0.97 * friction);
  World world = make_ramp(uneven_type(), slope, friction, 0.1);
  run(world, 0.5);
  const Vec3 start = world.piece(1).world_from_body.translation;
  const double before = yaw_of(world, 1, slope);
  run(world, 10);
  EXPECT_LT(std::abs(yaw_of(world, 1, slope) - before), 0.001);
  EXPECT_LT(distance(world.piece(1).world_from_body.translation, start), 0.001);
}

// On level ground: a bar of 1 x 0.2 x 0.1 m whose mass is 5 cm off one end. Whatever the pressures
// are, they balance that; the torque of friction is largest with all of them in the corners.
TEST(ClosedFormSlope, FrictionOfAnUnevenlyLoadedBarTurnsItNoMoreThanItsCornersCan) {
  const double friction = 0.3, gyration_squared = 0.05;
  PieceType bar = box_type("bar", 1, 0.2, 0.1);
  VolumeProperties volume;
  volume.volume = 1 * 0.2 * 0.1;
  volume.centre_of_mass = {0.45, 0, 0};
  volume.inertia = Mat3::diagonal(Vec3{0.01, gyration_squared, gyration_squared} * volume.volume);
  bar.volume = volume;
  bar.friction = friction;
  World world({bar}, awake_options());
  world.add({at(0, {-0.45, 0, 0.05 + kGap})});
  run(world, 0.5);
  world.set_velocity(0, {}, {0, 0, 5});
  const double seconds = 0.2;
  run(world, seconds);
  const double lever = 0.95 * std::hypot(0.05, 0.1) + 0.05 * std::hypot(0.95, 0.1);
  const double most = friction * kG * lever / gyration_squared * seconds;
  const double lost = 5 - world.piece(0).angular_velocity.z;
  EXPECT_LT(lost, 1.05 * most);
  EXPECT_GT(lost, 0.05 * most);  // the load spreads over some of its base
}

}  // namespace closed_forms_slope_test
}  // namespace rubble
