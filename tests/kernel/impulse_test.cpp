// Impulses from outside against closed forms: single pieces, rigid bodies, articulated trees.
#include <gtest/gtest.h>

#include "articulated_scene.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"
#include "kernel/world/world_structures.h"
#include "scenes.h"

namespace rubble {
namespace impulse_test {

using testing::at;
using testing::box_type;

WorldOptions weightless() {
  WorldOptions options;
  options.gravity = 0;
  options.threads = 1;
  return options;
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance, const char* what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << what << ", axis " << i;
}

// How the point of a piece moves.
Vec3 velocity_at(const World& world, int piece, int lead, const Vec3& point) {
  const Vec3 centre = world.piece(lead).world_from_body * world.centre_of_mass(lead);
  return world.structures().centre_velocity(piece) + cross(world.piece(piece).angular_velocity, point - centre);
}

TEST(Impulse, OfABoxIsThatOfNewtonAndEuler) {
  PieceType box = box_type("b", 0.4, 0.2, 0.1);
  World world({box}, weightless());
  world.add({at(0, {1, 2, 5})});
  const double mass = world.mass(0);
  const Vec3 point{1.2, 2.1, 5.05}, impulse{30, -20, 10};
  const Mat3 response = world.impulse_response(0, point);
  world.apply_impulse(0, point, impulse);
  const PieceState after = world.piece(0);
  expect_near(after.linear_velocity, impulse * (1 / mass), 1e-9, "speed");
  // Of a box about its axes: m (b2 + c2) / 12.
  const Vec3 moment = cross(Vec3{0.2, 0.1, 0.05}, impulse);
  const Vec3 spin{12 * moment.x / (mass * (0.04 + 0.01)), 12 * moment.y / (mass * (0.16 + 0.01)),
                  12 * moment.z / (mass * (0.16 + 0.04))};
  expect_near(after.angular_velocity, spin, 1e-6 * norm(spin), "spin");
  expect_near(velocity_at(world, 0, 0, point), response * impulse, 1e-9, "response");
}

TEST(Impulse, WakesAndMovesNothingThatIsFixed) {
  World world({box_type("b", 0.4, 0.4, 0.4)});
  world.add({at(0, {0, 0, 0.201}), at(0, {3, 0, 0.2}, {}, true)});
  ASSERT_TRUE(testing::run_to_rest(world, 3));
  world.rest().put_all_to_sleep();
  ASSERT_FALSE(world.is_awake(0));
  world.apply_impulse(0, {0, 0, 0.2}, {0, 0, 1e-3});
  EXPECT_TRUE(world.is_awake(0));
  world.apply_impulse(1, {3, 0, 0.2}, {1000, 0, 0});
  EXPECT_EQ(norm(world.piece(1).linear_velocity), 0);
  EXPECT_EQ(norm(world.impulse_response(1, {3, 0, 0.2}) * Vec3{1, 1, 1}), 0);
}

TEST(Impulse, OnAPieceMovesTheRigidBodyThatItIsPartOf) {
  World world({box_type("b", 0.2, 0.2, 0.2)}, weightless());
  world.add({at(0, {0, 0, 5}, {}, true), at(0, {0.2, 0, 5}, {}, true), at(0, {0.4, 0, 5}, {}, true)});
  const double mass = 2400 * 0.2 * 0.2 * 0.2;
  world.structures().bind(0, 3);
  world.structures().split({{{0, 1, 2}, false}});
  const Vec3 point{0.5, 0, 5}, impulse{0, 24, 0};
  const Mat3 response = world.impulse_response(2, point);
  world.apply_impulse(2, point, impulse);
  const double whole = 3 * world.mass(0) / 3;  // the lead has the mass of all
  EXPECT_NEAR(whole, 3 * mass, 1e-3 * mass);
  expect_near(world.structures().centre_velocity(1), impulse * (1 / whole), 1e-6, "speed");
  // A rod of 0.6 m and 0.2 m about its middle, 0.3 m from its end.
  EXPECT_NEAR(world.piece(1).angular_velocity.z, 0.3 * 24 / (whole * (0.36 + 0.04) / 12), 1e-4);
  expect_near(velocity_at(world, 2, world.structures().bound_with(2).front(), point), response * impulse, 1e-5, "response");
}

TEST(Impulse, OnALinkGoesThroughItsTreeAndKeepsMomentum) {
  const AssemblyType chain = testing::make_chain(3, 0.5, true, testing::joint_of(JointKind::hinge));
  World world = testing::make_world(chain, 0.5, weightless());
  NewPiece free;
  free.placement.kind = PieceKind::assembly(0);
  free.placement.world_from_body.translation = {0, 0, 4};
  const int first = world.add({free}), last = world.size() - 1;
  ASSERT_GE(last - first, 2);
  const Vec3 point = world.piece(last).world_from_body * world.centre_of_mass(last), impulse{0.3, 0.2, -0.4};
  const Mat3 response = world.impulse_response(last, point);
  const Vec3 angular = world.diagnostics().angular_momentum();
  world.apply_impulse(last, point, impulse);
  expect_near(world.diagnostics().linear_momentum(), impulse, 1e-9, "momentum");
  expect_near(world.diagnostics().angular_momentum() - angular, cross(point, impulse), 1e-9, "angular momentum");
  expect_near(velocity_at(world, last, last, point), response * impulse, 1e-9, "response");
  EXPECT_NE(norm(world.piece(first).angular_velocity - world.piece(last).angular_velocity), 0) << "the joints turn";
}

TEST(Impulse, ContactsCarryWhatLiesOnThem) {
  WorldOptions options;
  options.threads = 1;
  World world({box_type("b", 0.4, 0.4, 0.4)}, options);
  world.add({at(0, {0, 0, 0.201}), at(0, {0, 0, 0.602})});
  testing::run(world, 1);
  Vec3 on_lower, on_upper;
  for (const ContactImpulse& contact : world.contacts()) {
    ASSERT_GE(contact.piece, 0);
    const Vec3 force = contact.impulse * (1 / options.step);
    if (contact.other < 0) on_lower += force;
    if (contact.other >= 0) on_upper += contact.piece == 1 ? force : -force;
  }
  const double weight = world.mass(0) * options.gravity;
  EXPECT_NEAR(on_lower.z, 2 * weight, 0.02 * weight);
  EXPECT_NEAR(on_upper.z, weight, 0.02 * weight);
  EXPECT_TRUE(world.structures().contact_impulses().empty()) << "no rigid bodies of several pieces";
}

}  // namespace impulse_test
}  // namespace rubble
