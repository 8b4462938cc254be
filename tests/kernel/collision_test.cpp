#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/collision/gjk.h"
#include "kernel/collision/manifold.h"
#include "kernel/collision/narrow_phase.h"
#include "kernel/collision/placed_overlaps.h"
#include "kernel/collision/sat.h"
#include "kernel/geometry/shape.h"
#include "scenes.h"

namespace rubble {
namespace collision_test {

struct Posed {
  Posed(const Shape& compiled, const Quat& q) : shape(compiled.parts[0]) {
    rotation = Mat3f{{Vec3f(q.matrix().rows[0]), Vec3f(q.matrix().rows[1]), Vec3f(q.matrix().rows[2])}};
    for (const Vec3f& p : shape.corners) corners.push_back(rotation * p);
  }
  PosedPart part() const { return {&shape, {corners.data(), int(corners.size())}, &rotation}; }
  const ConvexShape& shape;
  Mat3f rotation;
  std::vector<Vec3f> corners;
};

TEST(Gjk, BoxesFaceToFace) {
  const Shape box = compile_shape(testing::box_type("b", 1, 1, 1), "t");
  const Posed a(box, {}), b(box, {});
  GjkCache cache;
  const GjkResult r =
      calc_distance(a.part().corners, b.part().corners, {0.3F, 0.2F, 1.001F}, 1, cache);
  ASSERT_EQ(r.kind, GjkResult::Kind::separated);
  EXPECT_NEAR(r.distance, 0.001, 1e-6);
  EXPECT_NEAR(r.normal.z, 1, 1e-5);
}

TEST(Gjk, AgreesWithTheAxisSearchOnRandomPairs) {
  RandomStream random(6, "test");
  const Shape chunk = compile_shape(testing::chunk_type("c", 3), "t");
  int separated = 0;
  for (int i = 0; i < 2000; ++i) {
    const Posed a(chunk, random.rotation()), b(chunk, random.rotation());
    const Vec3f offset(random.direction() * random.uniform(0.8, 2.2));
    GjkCache cache;
    const GjkResult r = calc_distance(a.part().corners, b.part().corners, offset, 1e30F, cache);
    const SatResult s = find_separating_axis(a.part(), b.part(), offset);
    if (r.kind == GjkResult::Kind::separated) {
      ++separated;
      // Faces and edges bound the distance from below; corner pairs reach farther. Merged faces
      // are off by less than a degree.
      EXPECT_LE(s.separation, r.distance + 5e-3);
      EXPECT_NEAR(norm(r.point_b - r.point_a), r.distance, 1e-4);
    } else {
      EXPECT_LT(s.separation, 1e-4);
    }
  }
  EXPECT_GT(separated, 300);
  EXPECT_LT(separated, 1900);
}

// Boxes at rest on each other: everything about them is flat and parallel, and the search starts
// from what it ended with a moment ago. To lose such a contact for one step makes a pile creep.
TEST(Gjk, NeverTakesTouchingBoxesForFarApart) {
  RandomStream random(8, "test");
  const Shape box = compile_shape(testing::box_type("b", 0.4, 0.4, 0.2), "t");
  for (int pair = 0; pair < 200; ++pair) {
    GjkCache cache;
    const double x = random.uniform(-0.1, 0.1), y = random.uniform(-0.1, 0.1);
    for (int step = 0; step < 100; ++step) {
      const Quat tilt = normalized(Quat{1, random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3),
                                        random.uniform(-1e-3, 1e-3)});
      const Posed a(box, {}), b(box, tilt);
      const Vec3f offset(float(x), float(y), 0.2F + float(random.uniform(-1e-3, 2e-3)));
      const GjkResult r = calc_distance(a.part().corners, b.part().corners, offset, 0.02F, cache);
      if (r.kind == GjkResult::Kind::overlapping) continue;
      ASSERT_LT(r.distance, 2.6e-3F) << "pair " << pair << ", step " << step;
    }
  }
}

TEST(Gjk, ACacheFromAnotherPlaceDoesNotChangeTheDistance) {
  RandomStream random(7, "test");
  const Shape chunk = compile_shape(testing::chunk_type("c", 3), "t");
  GjkCache kept;
  for (int i = 0; i < 500; ++i) {
    const Posed a(chunk, random.rotation()), b(chunk, random.rotation());
    const Vec3f offset(random.direction() * 2.2);
    GjkCache fresh;
    const float d1 = calc_distance(a.part().corners, b.part().corners, offset, 1e30F, fresh).distance;
    const float d2 = calc_distance(a.part().corners, b.part().corners, offset, 1e30F, kept).distance;
    EXPECT_NEAR(d1, d2, 2e-3 * d1 + 1e-6);
  }
}

TEST(Sat, DepthOfOverlappingBoxes) {
  const Shape box = compile_shape(testing::box_type("b", 1, 1, 1), "t");
  const Posed a(box, {}), b(box, testing::turned({0, 0, 1}, 0.3));
  const SatResult s = find_separating_axis(a.part(), b.part(), {0.1F, 0, 0.95F});
  EXPECT_NEAR(s.separation, -0.05, 1e-6);
  EXPECT_NEAR(s.normal.z, 1, 1e-6);
}

// Sides that are nearly level with the ramp, and edges that are nearly along its own: no pair of
// edges may pass for an axis that keeps them apart.
TEST(Sat, DepthOfAFineDrumInALongRamp) {
  const Shape ramp = compile_shape(testing::box_type("ramp", 300, 6, 1), "t");
  PieceType type = testing::box_type("drum", 1, 1, 1);
  type.parts[0].points.clear();
  for (int i = 0; i < 800; ++i) {
    const double angle = 2 * portable::kPi * (i / 2 + 0.5) / 400;
    type.parts[0].points.push_back({portable::sin(angle), i % 2 - 0.5, portable::cos(angle)});
  }
  const Shape drum = compile_shape(type, "t");
  RandomStream random(7, "test");
  const Quat slope = testing::turned({0, 1, 0}, 0.0873);
  const Posed below(ramp, slope);
  for (int i = 0; i < 100; ++i) {
    const Posed above(drum, slope * testing::turned({1, 0, 0}, random.uniform(-2e-4, 2e-4)) *
                                testing::turned({0, 1, 0}, random.uniform(0, 7)));
    const Vec3 offset = slope.rotate({random.uniform(-140, 140), 0, 1.5 - 0.0012});
    const SatResult s = find_separating_axis(below.part(), above.part(), Vec3f(offset));
    EXPECT_NEAR(s.separation, -0.0012, 0.0004) << i;
    EXPECT_GT(dot(Vec3(s.normal), slope.rotate({0, 0, 1})), 0.9998) << i;
  }
}

TEST(Manifold, BoxOnBoxHasFourCorners) {
  const Shape box = compile_shape(testing::box_type("b", 1, 1, 1), "t");
  const Posed a(box, {}), b(box, {});
  Manifold m;
  clip_faces(a.part(), b.part(), {0.5F, 0.25F, 1.001F}, {0, 0, 1}, 0.02F, m);
  ASSERT_EQ(m.count, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(m.points[i].separation, 0.001, 1e-6);
    EXPECT_GE(m.points[i].position.x, -1e-6);
    EXPECT_LE(m.points[i].position.x, 0.5 + 1e-6);
  }
}

TEST(Manifold, EdgeAgainstEdgeLeavesItToTheClosestPoints) {
  const Shape box = compile_shape(testing::box_type("b", 1, 1, 1), "t");
  const Quat up = testing::turned({1, 0, 0}, 0.785398);
  const Posed a(box, up), b(box, testing::turned({0, 0, 1}, 1.5707963) * up);
  Manifold m;
  clip_faces(a.part(), b.part(), {0, 0, 1.415F}, {0, 0, 1}, 0.02F, m);
  EXPECT_EQ(m.count, 0);
}

TEST(Manifold, TheDeepestPointAlwaysStays) {
  Manifold m;
  RandomStream random(8, "test");
  for (int i = 0; i < 20; ++i) {
    const float s = float(random.uniform(-0.01, 0.02));
    m.points[m.count++] = {Vec3f(float(random.uniform()), float(random.uniform()), 0), s, s};
  }
  float deepest = 1;
  for (int i = 0; i < m.count; ++i) deepest = std::min(deepest, m.points[i].predicted);
  reduce(m, {0, 0, 1}, 4);
  EXPECT_EQ(m.count, 4);
  float kept = 1;
  for (int i = 0; i < m.count; ++i) kept = std::min(kept, m.points[i].predicted);
  EXPECT_EQ(deepest, kept);
}

// A wheel that rolls at 200 rad/s, 1 mm above the ground: its corners ahead come down at up to
// 20 m/s, but none comes below the ground in the step, so no point may ask it to rise.
TEST(GroundContact, DoesNotThrowAFastWheelUp) {
  constexpr int kSides = 320;
  PieceType type = testing::box_type("wheel", 1, 1, 1);
  type.parts[0].points.clear();
  for (int i = 0; i < 2 * kSides; ++i) {
    const double angle = 2 * portable::kPi * (i / 2 + 0.5) / kSides;
    type.parts[0].points.push_back(
        {0.1 * portable::sin(angle), 0.05 * (i % 2), 0.1 * portable::cos(angle)});
  }
  const Shape wheel = compile_shape(type, "t");
  const Posed posed(wheel, {});
  PosedBody body{posed.part(), {0, 0, 0.101}, {20, 0, 0}, {0, 200, 0}};
  const NarrowSettings settings;
  Contact contact;
  update_ground_contact(contact, body, motion_margin({20, 0, 0}, 20.8F, settings), settings);
  ASSERT_GT(contact.count, 0);
  for (int i = 0; i < contact.count; ++i) {
    const ContactPoint& p = contact.points[i];
    const float falls = -(body.linear + cross(body.angular, p.from_a)).z;
    EXPECT_LT(falls - p.separation / settings.step, 0.05) << i;
  }
  // Falling at 3 m/s it must be caught: by 3 m/s less 1 mm a step.
  body.linear.z = -3;
  update_ground_contact(contact, body, motion_margin({20, 0, -3}, 20.8F, settings), settings);
  float most = 0;
  for (int i = 0; i < contact.count; ++i) {
    const ContactPoint& p = contact.points[i];
    const float falls = -(body.linear + cross(body.angular, p.from_a)).z;
    most = std::max(most, falls - p.separation / settings.step);
  }
  EXPECT_NEAR(most, 3 - 0.06, 0.05);
}

// A box of 1 m on a slab that it reaches 3 cm into, and one that only touches it.
TEST(PlacedOverlaps, AreFoundWithTheirDepth) {
  const std::vector<PieceType> types{testing::box_type("slab", 4, 4, 0.2), testing::box_type("box", 1, 1, 1)};
  const auto place = [](int type, const Vec3& at, bool fixed) {
    Placement placement;
    placement.kind = type, placement.fixed = fixed;
    placement.world_from_body.translation = at;
    return placement;
  };
  const std::vector<Placement> placed{place(0, {0, 0, 0.1}, true), place(1, {1, 0, 0.67}, false), place(1, {-1, 0, 0.7}, false)};
  const std::vector<PlacedOverlap> found = find_placed_overlaps(types, placed, 3, 0.005);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].a, 0);
  EXPECT_EQ(found[0].b, 1);
  EXPECT_NEAR(found[0].depth, 0.03, 1e-5);
  EXPECT_TRUE(find_placed_overlaps(types, placed, 3, 0.04).empty());
  EXPECT_EQ(find_placed_overlaps(types, placed, 1, 0.005).size(), found.size());  // all with the first
}

}  // namespace collision_test
}  // namespace rubble
