// What tips and what stands, against a rigid body that turns about its edge.
#include <gtest/gtest.h>

#include <cmath>

#include "closed_forms.h"

namespace rubble {
namespace closed_forms_tipping_test {

using namespace testing;

constexpr double kGap = 0.001;  // between surfaces at the start; unit: m

// A plank of 2 m over the edge of a table, its middle `beyond` past the edge.
World make_plank(double beyond, bool sleeping) {
  WorldOptions options;
  options.sleeping = sleeping;
  World world({box_type("table", 4, 2, 1), box_type("plank", 2, 0.2, 0.1)}, options);
  world.add({at(0, {-2, 0, 2.5}, {}, true), at(1, {beyond, 0, 3.05 + kGap})});
  return world;
}

// It turns about the edge: angle = (x / z) (cosh(w t) - 1) while it is small.
TEST(ClosedFormTipping, APlankFiveMillimetresPastItsBalanceTips) {
  for (const bool sleeping : {false, true}) {
    World world = make_plank(0.005, sleeping);
    const Toppling plank{0.005, 0.05, (4 + 0.01) / 12 + 0.005 * 0.005 + 0.05 * 0.05};
    const double expected = plank.calc_time(0.1);
    EXPECT_NEAR(expected, 1.09, 0.02);
    EXPECT_NEAR(measure_tilt_time(world, 1, 0.1, 10), expected, 0.05 * expected) << sleeping;
  }
}

TEST(ClosedFormTipping, APlankFiveMillimetresBeforeItsBalanceStays) {
  for (const bool sleeping : {false, true}) {
    World world = make_plank(-0.005, sleeping);
    run(world, 10);
    EXPECT_LT(std::abs(tilt_of(world, 1)), 0.001) << sleeping;
    EXPECT_NEAR(world.piece(1).world_from_body.translation.x, -0.005, 0.0005) << sleeping;
  }
}

// A beam of 4 m on two supports, whose overhang carries a block of `share` of the mass that lifts
// the beam off its far support: M 1.2 m = m 0.6 m about the outer edge of the near one.
struct Beam {
  static constexpr double kMass = 2400 * 4 * 0.3 * 0.2, kEdge = 0.6, kLoadAt = 1.8, kLoad = 0.3;
  double load;  // unit: kg

  explicit Beam(double share) : load(share * kMass * kEdge / (kLoadAt - kEdge)) {}

  World make() const {
    PieceType block = box_type("load", kLoad, kLoad, kLoad);
    block.density = load / (kLoad * kLoad * kLoad);
    World world({box_type("support", 0.2, 0.6, 1), box_type("beam", 4, 0.3, 0.2), block},
                awake_options());
    world.add({at(0, {kEdge - 0.1, 0, 2}, {}, true), at(0, {-1.5, 0, 2}, {}, true),
               at(1, {0, 0, 2.6 + kGap}), at(2, {kLoadAt, 0, 2.7 + kLoad / 2 + 2 * kGap})});
    return world;
  }

  Toppling topple() const {
    const double total = kMass + load, from_edge = kLoadAt - kEdge, load_z = 0.2 + kLoad / 2;
    const double beam = kMass * ((16 + 0.04) / 12 + kEdge * kEdge + 0.01);
    const double block = load * (kLoad * kLoad / 6 + from_edge * from_edge + load_z * load_z);
    return {(load * from_edge - kMass * kEdge) / total, (load * load_z + kMass * 0.1) / total,
            (beam + block) / total};
  }
};

TEST(ClosedFormTipping, ABeamOnTwoSupportsStaysWhileItsOverhangIsLightEnough) {
  World world = Beam(0.98).make();
  run(world, 10);
  EXPECT_LT(std::abs(tilt_of(world, 2)), 0.001);
  EXPECT_LT(std::abs(world.piece(2).world_from_body.translation.x), 0.001);
}

TEST(ClosedFormTipping, ABeamOnTwoSupportsTipsWhenItsOverhangIsTooHeavy) {
  const Beam beam(1.03);
  World world = beam.make();
  const double expected = beam.topple().calc_time(0.1);
  EXPECT_NEAR(measure_tilt_time(world, 2, 0.1, 10), expected, 0.07 * expected);
}

// A box on its lower edge, leaning `past` beyond the upright of its middle, released at rest.
World make_leaning(double width, double height, double past) {
  const double tilt = std::atan2(width, height) + past;
  PieceType type = box_type("box", width, 2, height);
  type.friction = 0.8;
  World world({type}, awake_options());
  const Toppling t = topple_box(width, height, tilt);
  world.add({at(0, {t.x, 0, t.z + kGap}, turned({0, 1, 0}, tilt))});
  return world;
}

// To 45 degrees: until there the edge needs less friction than 0.4 and does not slip.
void fall_from_edge(double width, double height, double past) {
  World world = make_leaning(width, height, past);
  const double tilt = std::atan2(width, height) + past, end = 0.7853981634;
  const double expected = topple_box(width, height, tilt).calc_time(end - tilt);
  EXPECT_NEAR(measure_tilt_time(world, 0, end, 20), expected, 0.05 * expected)
      << width << " past by " << past;
}

TEST(ClosedFormTipping, ASlabOnEdgeFallsInItsTime) {
  for (const double past : {0.005, 0.02, 0.1}) fall_from_edge(0.1, 2, past);
}

TEST(ClosedFormTipping, AColumnFallsInTheTimeOfARod) {
  for (const double past : {0.005, 0.02, 0.1}) fall_from_edge(0.3, 3, past);
}

// Struck so that it turns about an edge with `share` of the energy that lifts its middle over it.
World make_struck_column(double share, double& spin) {
  PieceType type = box_type("column", 0.3, 0.3, 3);
  type.friction = 0.8;
  World world({type}, awake_options());
  world.add({at(0, {0, 0, 1.5 + kGap})});
  run(world, 1);
  const Toppling t = topple_box(0.3, 3, 0);
  spin = std::sqrt(share * 2 * kG * (std::hypot(0.15, 1.5) - 1.5) / t.gyration_squared);
  world.set_velocity(0, {spin * 1.5, 0, spin * 0.15}, {0, spin, 0});
  return world;
}

TEST(ClosedFormTipping, AColumnStands) {
  for (const bool sleeping : {false, true}) {
    WorldOptions options;
    options.sleeping = sleeping;
    World world({box_type("column", 0.3, 0.3, 3)}, options);
    world.add({at(0, {0, 0, 1.5 + kGap})});
    run(world, 20);
    EXPECT_LT(std::abs(tilt_of(world, 0)), 0.0005) << sleeping;
    EXPECT_LT(std::abs(world.piece(0).world_from_body.translation.x), 0.001) << sleeping;
  }
}

// A slender block that rocks from edge to edge keeps (1 - 1.5 sin^2 a)^2 of its energy at each impact (Housner 1963; a: the
// half angle that it stands under), so it takes some 40 s until 0.002 rad are left. With its edges a little rounded by
// the gap at rest, it may lose up to three times as much.
TEST(ClosedFormTipping, AColumnStruckTooLightlyRocksBack) {
  double spin = 0;
  World world = make_struck_column(0.8, spin);
  const double radius = std::hypot(0.15, 1.5), half_angle = std::atan2(0.15, 1.5);
  const double lost = 1 - std::pow(1 - 1.5 * std::sin(half_angle) * std::sin(half_angle), 2);
  double energy = 0.8, before = 0, last = 0;  // before, last: tilts of the last two steps; unit: rad
  int peaks = 0;
  while (world.time() < 45) {
    world.step();
    const double tilt = std::abs(tilt_of(world, 0));
    if (last > before && last >= tilt && last > 0.01) {
      const double share = (radius * std::cos(half_angle - last) - 1.5) / (radius - 1.5);
      if (peaks++ > 0) {
        EXPECT_LT(share, energy * (1 - 0.8 * lost)) << world.time();
        EXPECT_GT(share, energy * (1 - 3 * lost)) << world.time();
      }
      energy = share;
    }
    before = last, last = tilt;
  }
  EXPECT_GT(peaks, 10);
  EXPECT_LT(last, 0.002);
  EXPECT_GT(world.piece(0).world_from_body.translation.z, 1.49);
}

TEST(ClosedFormTipping, AColumnStruckHardEnoughFallsInItsTime) {
  double spin = 0;
  World world = make_struck_column(1.2, spin);
  Toppling rod = topple_box(0.3, 3, 0);
  rod.spin = spin;
  const double expected = rod.calc_time(0.7853981634);
  EXPECT_NEAR(measure_tilt_time(world, 0, 0.7853981634, 15), expected, 0.06 * expected);
}

// A block of 0.4 x 0.4 x 1 m on a ramp: it stands up to tan(a) = 0.4, held at its lower edge.
World make_tall_block(double slope, double friction) {
  PieceType ramp = box_type("ramp", 40, 4, 1), block = box_type("block", 0.4, 0.4, 1);
  ramp.friction = block.friction = friction;
  World world({ramp, block}, awake_options());
  const Quat q = turned({0, 1, 0}, slope);
  world.add({at(0, {0, 0, 20}, q, true), at(1, Vec3{0, 0, 20} + q.rotate({-15, 0, 1 + kGap}), q)});
  return world;
}

TEST(ClosedFormTipping, ATallBlockHeldAtItsLowerEdgeStays) {
  const double slope = std::atan(0.4 * 0.97);
  World world = make_tall_block(slope, 0.9);
  run(world, 1);
  const Vec3 start = world.piece(1).world_from_body.translation;
  run(world, 10);
  EXPECT_NEAR(tilt_of(world, 1), slope, 0.001);
  EXPECT_LT(distance(world.piece(1).world_from_body.translation, start), 0.001);
}

TEST(ClosedFormTipping, ATallBlockOnTooSteepARampTopplesInItsTime) {
  const double slope = std::atan(0.4 * 1.05);
  World world = make_tall_block(slope, 0.9);
  const double expected = topple_box(0.4, 1, slope).calc_time(0.3);
  EXPECT_NEAR(measure_tilt_time(world, 1, slope + 0.3, 10), expected, 0.06 * expected);
}

// What slides is pressed less on its lower edge: it tips where friction > 0.4, whatever the slope.
TEST(ClosedFormTipping, ATallBlockThatSlidesDoesNotTipWhereFrictionIsLow) {
  const double slope = std::atan(0.6), friction = 0.35;
  World world = make_tall_block(slope, friction);
  const Vec3 start = world.piece(1).world_from_body.translation;
  run(world, 2);
  const double expected = 0.5 * kG * (std::sin(slope) - friction * std::cos(slope)) * 4;
  EXPECT_NEAR(tilt_of(world, 1), slope, 0.01);
  EXPECT_NEAR(distance(world.piece(1).world_from_body.translation, start), expected,
              0.02 * expected);
}

TEST(ClosedFormTipping, ATallBlockThatSlidesTipsWhereFrictionIsHigh) {
  World world = make_tall_block(std::atan(0.6), 0.5);
  run(world, 3);
  EXPECT_GT(tilt_of(world, 1), std::atan(0.6) + 1);
}

}  // namespace closed_forms_tipping_test
}  // namespace rubble
