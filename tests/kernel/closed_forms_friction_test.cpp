// Friction of patches that slide and spin, and of impacts, against Coulomb's law integrated over the patch.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "closed_forms.h"

namespace rubble {
namespace closed_forms_friction_test {

using namespace testing;

constexpr double kFriction = 0.4;
constexpr double kThickness = 0.1;  // thin, so that friction hardly shifts the pressure; unit: m

// A patch under even pressure, as a grid of points about its centre, and the radius of gyration of what stands on it.
struct Patch {
  std::vector<double> x, y;
  double gyration_squared = 0;  // unit: m2
};

Patch make_patch(double width, double depth, double radius) {
  const int n = 24;
  Patch patch;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = width * ((i + 0.5) / n - 0.5), y = depth * ((j + 0.5) / n - 0.5);
      if (radius > 0 && x * x + y * y > radius * radius) continue;
      patch.x.push_back(x), patch.y.push_back(y);
    }
  }
  patch.gyration_squared = radius > 0 ? radius * radius / 2 : (width * width + depth * depth) / 12;
  return patch;
}

struct Way {
  double slid = 0, turned = 0;  // unit: m, rad
};

// Until it stops: each point has the friction that opposes its own slip.
Way integrate(const Patch& patch, double speed, double spin) {
  const double dt = 1e-3, smooth = 1e-5;  // smooth: squared slip below which friction fades; unit: m2/s2
  double x = 0, y = 0, angle = 0, vx = speed, vy = 0, w = spin;
  while (std::hypot(vx, vy) > 0.003 || std::abs(w) > 0.01) {
    const double c = std::cos(angle), s = std::sin(angle);
    double fx = 0, fy = 0, torque = 0;
    for (std::size_t i = 0; i < patch.x.size(); ++i) {
      const double px = c * patch.x[i] - s * patch.y[i], py = s * patch.x[i] + c * patch.y[i];
      const double ux = vx - w * py, uy = vy + w * px, per_slip = 1 / std::sqrt(ux * ux + uy * uy + smooth);
      fx -= ux * per_slip, fy -= uy * per_slip;
      torque -= (px * uy - py * ux) * per_slip;
    }
    const double each = kFriction * kG / double(patch.x.size()) * dt;
    vx += fx * each, vy += fy * each, w += torque * each / patch.gyration_squared;
    x += vx * dt, y += vy * dt, angle += w * dt;
  }
  return {std::hypot(x, y), angle};
}

struct Start {
  double speed, spin;  // unit: m/s, rad/s
};
constexpr Start kStarts[] = {{1, 0}, {1, 1}, {0.05, 6}, {0.6, 6}, {2, 6}, {5, 6}};

void expect_way(const std::vector<PieceType>& types, const std::vector<AssemblyType>& assemblies, PieceKind kind,
                const Quat& rotation, const Patch& patch, double share) {
  for (const double rate : {60.0, 240.0}) {
    for (const Start& start : kStarts) {
      WorldOptions options = awake_options();
      options.step = 1 / rate;
      options.threads = 1;
      World world(types, options, assemblies);
      const Vec3 middle{0, 0, kThickness / 2 + 0.001};
      world.add({at(kind, middle, rotation)});
      const Vec3 before = world.piece(0).world_from_body.translation, spin{0, 0, start.spin};
      world.set_velocity(0, Vec3{start.speed, 0, 0} + cross(spin, before - middle), spin);
      Way way;
      while (world.time() < 2.5) {
        world.step();
        way.turned += world.piece(0).angular_velocity.z / rate;
      }
      const Vec3 moved = world.piece(0).world_from_body.translation -
                         turned({0, 0, 1}, way.turned).rotate(before - middle);  // of the middle
      way.slid = std::hypot(moved.x, moved.y);
      const Way expected = integrate(patch, start.speed, start.spin);
      const std::string label = std::to_string(rate) + " Hz, " + std::to_string(start.speed) + " m/s, " +
                                std::to_string(start.spin) + " rad/s";
      EXPECT_NEAR(way.slid, expected.slid, share * expected.slid + 0.004) << label;
      EXPECT_NEAR(way.turned, expected.turned, share * expected.turned + 0.03) << label;
    }
  }
}

PieceType with_friction(PieceType type) {
  type.friction = kFriction;
  return type;
}

TEST(ClosedFormFriction, ASquarePlateSlidesAndSpins) {
  expect_way({with_friction(box_type("plate", 1, 1, kThickness))}, {}, 0, {}, make_patch(1, 1, 0), 0.03);
}

TEST(ClosedFormFriction, AnOblongPlateSlidesAndSpins) {
  expect_way({with_friction(box_type("plate", 1.2, 0.4, kThickness))}, {}, 0, {}, make_patch(1.2, 0.4, 0), 0.06);
}

TEST(ClosedFormFriction, ADiscSlidesAndSpins) {
  expect_way({with_friction(drum_type(0.3, kThickness, 48))}, {}, 0, turned({1, 0, 0}, 1.5707963267948966),
             make_patch(0.6, 0.6, 0.3), 0.12);
}

// Links of trees have the same law: a light block is welded onto the plate.
TEST(ClosedFormFriction, APlateOfATreeSlidesAndSpins) {
  AssemblyType plate;
  plate.name = "plate";
  plate.links = {{0, {}, 1}, {1, {{}, {0, 0, kThickness / 2 + 0.02}}, 1}};
  plate.joints.emplace_back();
  plate.joints[0].kind = JointKind::weld;
  PieceType block = box_type("block", 0.04, 0.04, 0.04);
  block.density = 100;
  expect_way({with_friction(box_type("plate", 1, 1, kThickness)), block}, {plate},
             PieceKind::assembly(0), {}, make_patch(1, 1, 0), 0.03);
}

// What lands flat while it slides gets the coefficient times the normal impulse, at any speed and step.
TEST(ClosedFormFriction, ABoxThatLandsFlatIsBrakedByTheWholeImpulse) {
  for (const double rate : {60.0, 240.0}) {
    for (const double height : {0.05, 0.1, 0.2}) {
      for (const double fall : {0.5, 2.0, 5.0}) {
        WorldOptions options = awake_options();
        options.step = 1 / rate;
        options.threads = 1;
        World world({with_friction(box_type("box", 0.4, 0.4, height))}, options);
        NewPiece box = at(0, {0, 0, height / 2 + 0.001 + 0.5 * fall / rate});
        box.linear_velocity = {20, 0, -fall};
        world.add({box});
        run(world, 0.1);
        const Vec3 after = world.piece(0).linear_velocity;
        ASSERT_NEAR(after.z, 0, 0.01);
        EXPECT_NEAR((20 - after.x) / (kFriction * (fall + kG * world.time())), 1, 0.01)
            << rate << " Hz, " << height << " m high, " << fall << " m/s";
      }
    }
  }
}

// Wherever a cube is pulled, the ground carries its weight and brakes it by no more than the coefficient times that.
TEST(ClosedFormFriction, ACubeIsBrakedAlikeWhereverItIsPulled) {
  for (const double rate : {60.0, 240.0}) {
    for (const double height : {-0.15, -0.05, 0.0, 0.05}) {  // above its centre; unit: m
      for (const double pull : {0.6, 1.0}) {  // over its weight
        WorldOptions options = awake_options();
        options.step = 1 / rate;
        options.threads = 1;
        World world({with_friction(box_type("cube", 0.4, 0.4, 0.4))}, options);
        world.add({at(0, {0, 0, 0.201})});
        run(world, 0.2);
        const double impulse = pull * world.mass(0) * kG / rate;
        for (int i = 0; i < int(rate); ++i) {
          world.apply_impulse(0, world.piece(0).world_from_body.translation + Vec3{0, 0, height}, {impulse, 0, 0});
          world.step();
        }
        const double braked = pull - world.piece(0).linear_velocity.x / kG;
        EXPECT_NEAR(braked, kFriction, 0.01 * kFriction) << rate << " Hz, " << height << " m, pull " << pull;
      }
    }
  }
}

}  // namespace closed_forms_friction_test
}  // namespace rubble
