// Free rotation against Euler's equations, and speeds that no limit may cut.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "closed_forms.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace closed_forms_spin_test {

using namespace testing;

constexpr double kX = 0.5, kY = 0.2, kZ = 0.1;  // the body; inertias about X < Y < Z; unit: m
const Vec3 kInertia{(kY * kY + kZ * kZ) / 12, (kX * kX + kZ * kZ) / 12, (kX * kX + kY * kY) / 12};

Vec3 calc_euler(const Vec3& w) {
  const Vec3& i = kInertia;
  return {(i.y - i.z) * w.y * w.z / i.x, (i.z - i.x) * w.z * w.x / i.y,
          (i.x - i.y) * w.x * w.y / i.z};
}

// Spin in the body's frame after `seconds`, by Runge-Kutta of fourth order.
Vec3 solve_euler(Vec3 w, double seconds) {
  const int steps = 20000;
  const double dt = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const Vec3 a = calc_euler(w), b = calc_euler(w + a * (dt / 2));
    const Vec3 c = calc_euler(w + b * (dt / 2)), d = calc_euler(w + c * dt);
    w += (a + b * 2.0 + c * 2.0 + d) * (dt / 6);
  }
  return w;
}

// Of the spin in the body's frame: Jacobi's elliptic functions (Landau and Lifshitz, Mechanics,
// 37).
double calc_period(const Vec3& w) {
  double first = kInertia.x, last = kInertia.z;
  const double middle = kInertia.y;
  const Vec3 l{first * w.x, middle * w.y, last * w.z};
  const double twice_energy = dot(l, w), squared = dot(l, l);
  if (squared < twice_energy * middle) std::swap(first, last);
  const double a = (last - middle) * (squared - twice_energy * first);
  const double b = (middle - first) * (twice_energy * last - squared);
  double mean = 1, geometric = std::sqrt(1 - b / a);  // K by the arithmetic-geometric mean
  for (int i = 0; i < 40; ++i) {
    const double next = (mean + geometric) / 2;
    geometric = std::sqrt(mean * geometric);
    mean = next;
  }
  const double quarter = 3.14159265358979323846 / (2 * mean);
  return 4 * quarter * std::sqrt(first * middle * last / a);
}

World make_tumbling(const Vec3& spin) {
  World world({box_type("body", kX, kY, kZ)}, weightless_options());
  NewPiece piece = at(0, {0, 0, 5});
  piece.angular_velocity = spin;
  world.add({piece});
  return world;
}

Vec3 body_spin(const World& world) {
  const PieceState piece = world.piece(0);
  return piece.world_from_body.rotation.conjugate().rotate(piece.angular_velocity);
}

const Vec3 kFlipping{0.5, 5, 0.25};  // near the middle axis, which is not stable; unit: rad/s

TEST(ClosedFormSpin, TheTwoReferencesAgree) {
  const Vec3 after = solve_euler(kFlipping, calc_period(kFlipping));
  EXPECT_LT(norm(after - kFlipping), 1e-6);
}

TEST(ClosedFormSpin, TumblingKeepsItsAngularMomentumAndItsEnergy) {
  for (const double seconds : {1.0, 20.0}) {
    for (const Vec3& spin : {kFlipping, Vec3{6, 0.1, 0.1}, Vec3{0.1, 0.2, 8}, Vec3{3, 3, 3}}) {
      World world = make_tumbling(spin);
      const Vec3 before = world.diagnostics().angular_momentum();
      const double energy = world.diagnostics().kinetic_energy();
      run(world, seconds);
      EXPECT_NEAR(norm(world.diagnostics().angular_momentum()), norm(before), 1e-9 * norm(before))
          << seconds << " s, spin " << spin.x << " " << spin.y << " " << spin.z;
      EXPECT_LT(norm(world.diagnostics().angular_momentum() - before), 1e-9 * norm(before)) << seconds;
      EXPECT_NEAR(world.diagnostics().kinetic_energy(), energy, 0.01 * energy) << seconds;
    }
  }
}

// The spin about the middle axis changes its sign twice in each period; 20 s hold several.
TEST(ClosedFormSpin, ABodyFlipsWithThePeriodOfItsEllipticFunctions) {
  World world = make_tumbling(kFlipping);
  std::vector<double> turns;
  double last = kFlipping.y;
  while (world.time() < 20) {
    world.step();
    const double now = body_spin(world).y;
    if ((now > 0) != (last > 0)) turns.push_back(world.time() - (1.0 / 60) * now / (now - last));
    last = now;
  }
  const double period = calc_period(kFlipping);
  ASSERT_NEAR(double(turns.size()), 2 * 20 / period, 1.01);
  const double measured = 2 * (turns.back() - turns.front()) / double(turns.size() - 1);
  EXPECT_NEAR(measured, period, 0.01 * period);
}

TEST(ClosedFormSpin, ASecondOfTumblingFollowsEulersEquations) {
  World world = make_tumbling(kFlipping);
  run(world, 1);
  EXPECT_LT(norm(body_spin(world) - solve_euler(kFlipping, 1)), 0.03 * norm(kFlipping));
}

// 200 rad/s and 60 m/s: in the air, and flat on ground without friction, where contacts in single
// precision may take 1 %.
TEST(ClosedFormSpin, NothingLimitsWhatIsFreeOrTouches) {
  PieceType disc = drum_type(0.2, 0.05, 48);
  disc.friction = 0;
  const Quat flat = turned({1, 0, 0}, 1.5707963267948966);
  for (const bool touching : {false, true}) {
    World world({disc}, touching ? WorldOptions{} : weightless_options());
    NewPiece piece = at(0, {-30, 0, touching ? 0.026 : 5}, flat);
    piece.linear_velocity = {60, 0, 0};
    piece.angular_velocity = {0, 0, 200};
    world.add({piece});
    run(world, 1);
    const PieceState after = world.piece(0);
    EXPECT_EQ(world.is_touching(0), touching);
    EXPECT_NEAR(after.linear_velocity.x, 60, touching ? 0.06 : 1e-9) << touching;
    EXPECT_NEAR(after.angular_velocity.z, 200, touching ? 2 : 0.002) << touching;
    EXPECT_NEAR(after.world_from_body.translation.x, 30, 0.06) << touching;
  }
}

// Slow motion is not braked either: no friction, no loss, asleep or not.
TEST(ClosedFormSpin, SlowMotionWithoutFrictionGoesOn) {
  PieceType disc = drum_type(0.2, 0.05, 48);
  disc.friction = 0;
  for (const bool sleeping : {false, true}) {
    WorldOptions options;
    options.sleeping = sleeping;
    World world({disc}, options);
    NewPiece piece = at(0, {0, 0, 0.026}, turned({1, 0, 0}, 1.5707963267948966));
    piece.linear_velocity = {0.05, 0, 0};
    piece.angular_velocity = {0, 0, 0.2};
    world.add({piece});
    run(world, 5);
    EXPECT_NEAR(world.piece(0).linear_velocity.x, 0.05, 0.0005) << sleeping;
    EXPECT_NEAR(world.piece(0).angular_velocity.z, 0.2, 0.004) << sleeping;
  }
}

// A cube that is balanced on a corner and spins about the vertical: the patch under the corner brakes it
// by mu m g r / I, where I is m a^2 / 6 about every axis. As one piece, and as two halves that are welded.
AssemblyType make_halves(double edge) {
  AssemblyType cube;
  cube.name = "cube";
  cube.links = {{1, {{}, {0, 0, -edge / 4}}, 1}, {1, {{}, {0, 0, edge / 4}}, 1}};
  cube.joints.emplace_back();
  cube.joints[0].kind = JointKind::weld;
  return cube;
}

TEST(ClosedFormSpin, ThePatchUnderACornerBrakesASpinAboutIt) {
  const double edge = 0.2, friction = 0.6, patch = 0.001, start = 0.2;
  const double braking = friction * kG * patch * 6 / (edge * edge);  // unit: rad/s2
  const Vec3 axis = normalized(cross(Vec3{1, 1, 1}, Vec3{0, 0, 1}));
  const Quat on_corner = turned(axis, std::acos(1 / std::sqrt(3.0)));
  for (const PieceKind kind : {PieceKind(0), PieceKind::assembly(0)}) {
    World world({box_type("cube", edge, edge, edge), box_type("half", edge, edge, edge / 2)},
                awake_options(), {make_halves(edge)});
    NewPiece cube = at(kind, {0, 0, edge * std::sqrt(0.75) + 0.001}, on_corner);
    cube.angular_velocity = {0, 0, start};
    world.add({cube});
    run(world, 0.1);  // it is at rest but for the spin from the first step on
    EXPECT_NEAR(world.piece(0).angular_velocity.z, start - 0.1 * braking, 0.03 * start) << kind.is_assembly;
    run(world, start / braking - 0.1 + 0.02);
    EXPECT_NEAR(world.piece(0).angular_velocity.z, 0, 0.01 * start) << kind.is_assembly;
  }
}

}  // namespace closed_forms_spin_test
}  // namespace rubble
