// Meshes cut into convex parts, against shapes whose parts and volumes are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/decompose.h"
#include "kernel/geometry/hull.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace decompose_test {

void add_box(TriangleMesh& mesh, const Vec3f& low, const Vec3f& high) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  static const std::uint32_t kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                              {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                              {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    mesh.surfaces.push_back(0);
  }
  mesh.surface_names = {"concrete_cast"};
}

double volume_of(const std::vector<ConvexPart>& parts) {
  double volume = 0;
  for (const ConvexPart& part : parts) volume += calc_volume_properties(part).volume;
  return volume;
}

TEST(Decompose, AConvexMeshIsOnePart) {
  TriangleMesh box;
  add_box(box, {0, 0, 0}, {0.5f, 0.3f, 0.2f});
  const auto parts = decompose(box).parts;
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(volume_of(parts), 0.03, 1e-6);
  EXPECT_EQ(parts[0].points.size(), 8u);
}

// An L and a table: the parts are the boxes they were made of, in volume and number.
TEST(Decompose, FindsTheBoxesOfAnL) {
  TriangleMesh l;
  add_box(l, {0, 0, 0}, {1, 0.3f, 0.2f});
  add_box(l, {0, 0, 0.2f}, {0.2f, 0.3f, 1});
  const auto parts = decompose(l).parts;
  EXPECT_GE(parts.size(), 2u);
  EXPECT_LE(parts.size(), 4u);
  EXPECT_NEAR(volume_of(parts), 0.06 + 0.048, 0.008) << "one hull: 0.2";
}

double share_beyond(const TriangleMesh& mesh, const std::vector<ConvexPart>& parts) {
  return volume_of(parts) / calc_volume_properties(mesh).volume - 1;
}

TEST(Decompose, CutsUnionsOfBoxesWithoutError) {
  TriangleMesh beam;  // two boxes that touch
  add_box(beam, {0, 0, 0}, {1, 0.3f, 0.2f});
  add_box(beam, {0, 0, 0.2f}, {0.2f, 0.3f, 1});
  const auto parts = decompose(beam).parts;
  EXPECT_EQ(parts.size(), 2u);
  EXPECT_NEAR(share_beyond(beam, parts), 0, 1e-6);
}

// A prism over an outline in the plane of X and Z, counter-clockwise seen from -Y, as one surface.
// faces: of its front, triangles of corners of the outline.
TriangleMesh make_prism(const std::vector<std::array<float, 2>>& outline,
                        const std::vector<std::array<std::uint32_t, 3>>& faces, float depth) {
  TriangleMesh mesh;
  const auto n = std::uint32_t(outline.size());
  for (const float y : {0.0f, depth})
    for (const auto& p : outline) mesh.positions.push_back({p[0], y, p[1]});
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0] + n, f[2] + n, f[1] + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, i + n, next + n});
    mesh.triangles.push_back({i, next + n, next});
  }
  return mesh;
}

TriangleMesh make_l_prism(float slant = 0) {
  return make_prism({{0, 0}, {1, 0}, {1 - slant, 0.2f}, {0.2f, 0.2f}, {0.2f, 1}, {0, 1}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 0.3f);
}

// As one surface, however it is turned: the faces of the parts are its own.
TEST(Decompose, CutsATurnedLBeamOfOneSurfaceIntoTwoBoxes) {
  TriangleMesh beam = make_l_prism();
  ASSERT_NEAR(calc_volume_properties(beam).volume, (0.2 + 0.16) * 0.3, 1e-6);
  for (const Vec3& rpy : {Vec3{0, 0, 0}, Vec3{0.4, 0.9, 1.3}}) {
    const Quat turn = portable::quat_from_rpy(rpy.x, rpy.y, rpy.z);
    TriangleMesh turned = beam;
    for (Vec3f& p : turned.positions) p = Vec3f(turn.rotate(Vec3(p)) + Vec3{3, -2, 1});
    const auto parts = decompose(turned).parts;
    EXPECT_EQ(parts.size(), 2u);
    EXPECT_NEAR(share_beyond(turned, parts), 0, 1e-5);
  }
  // The control: with a slanted end it is no union of boxes.
  EXPECT_FALSE(decompose(make_l_prism(0.1f)).exact);
}

TEST(Decompose, CutsStairsOfOneSurfaceIntoTheirSteps) {
  const TriangleMesh stairs = make_prism(
      {{0, 0}, {0.9f, 0}, {0.9f, 0.2f}, {0.6f, 0.2f}, {0.6f, 0.4f}, {0.3f, 0.4f}, {0.3f, 0.6f}, {0, 0.6f}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}}, 1.0f);
  const auto steps = decompose(stairs).parts;
  EXPECT_EQ(steps.size(), 3u);
  EXPECT_NEAR(share_beyond(stairs, steps), 0, 1e-6);
}

TEST(Decompose, LeavesTheSpaceUnderATableFree) {
  TriangleMesh table;
  add_box(table, {-0.7f, -0.4f, 0.7f}, {0.7f, 0.4f, 0.75f});
  for (const float x : {-0.65f, 0.57f}) {
    for (const float y : {-0.35f, 0.27f}) add_box(table, {x, y, 0}, {x + 0.08f, y + 0.08f, 0.7f});
  }
  const double expected = 1.4 * 0.8 * 0.05 + 4 * 0.08 * 0.08 * 0.7;
  const auto parts = decompose(table).parts;
  EXPECT_GE(parts.size(), 5u);
  EXPECT_LE(parts.size(), 16u);
  EXPECT_NEAR(volume_of(parts), expected, 0.15 * expected);
  // The negative control: one part would hold ten times as much.
  DecomposeOptions one;
  one.max_parts = one.most_parts = 1, one.resolution = 32;
  EXPECT_GT(volume_of(decompose(table, one).parts), 5 * expected);
}

TEST(Decompose, KeepsToItsLimitsAndToTheSurface) {
  TriangleMesh ring;  // a square ring of eight boxes
  for (int i = 0; i < 4; ++i) {
    const float s = 0.5f, t = 0.12f;
    add_box(ring, {i < 2 ? (i ? s - t : -s) : -s, i < 2 ? -s : (i == 2 ? -s : s - t), 0},
            {i < 2 ? (i ? s : -s + t) : s, i < 2 ? s : (i == 2 ? -s + t : s), 0.1f});
  }
  DecomposeOptions options;
  options.max_parts = 6, options.max_corners = 12;
  const auto parts = decompose(ring, options).parts;
  EXPECT_GE(parts.size(), 4u);
  EXPECT_LE(parts.size(), 6u);
  for (const ConvexPart& part : parts) {
    EXPECT_LE(part.points.size(), 12u);
    for (const Vec3& p : part.points) {
      EXPECT_LE(std::max(std::fabs(p.x), std::fabs(p.y)), 0.5 + 1e-6);
      EXPECT_GE(p.z, -1e-6);
      EXPECT_LE(p.z, 0.1 + 1e-6);
    }
  }
}

TEST(Decompose, TakesOpenMeshesAndThinSheet) {
  TriangleMesh sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0.5f, 0}, {0, 0.5f, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto parts = decompose(sheet).parts;
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(volume_of(parts), 0.5 * DecomposeOptions{}.thinnest, 1e-5);
  TriangleMesh line;
  line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(decompose(line), InputError);
}

TEST(Decompose, GivesTheSameBitsAgain) {
  TriangleMesh l;
  add_box(l, {0, 0, 0}, {1, 0.3f, 0.2f});
  add_box(l, {0, 0, 0.15f}, {0.2f, 0.3f, 1});
  const auto a = decompose(l).parts, b = decompose(l).parts;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].points, b[i].points);
}

// A solid of revolution about Z: an outline in the plane of X and Z, counter-clockwise seen from -Y.
TriangleMesh revolve(const std::vector<std::array<double, 2>>& outline, std::uint32_t sides) {
  TriangleMesh mesh;
  for (const auto& p : outline)
    for (std::uint32_t k = 0; k < sides; ++k) {
      const auto [sine, cosine] = portable::sincos(2 * portable::kPi * k / sides);
      mesh.positions.push_back(Vec3f(Vec3{p[0] * cosine, p[0] * sine, p[1]}));
    }
  const auto n = std::uint32_t(outline.size());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if (!(p == q) && !(q == r) && !(r == p)) mesh.triangles.push_back({a, b, c});
  };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t i2 = (i + 1) % n, k2 = (k + 1) % sides;
      add(i * sides + k, i * sides + k2, i2 * sides + k2);
      add(i * sides + k, i2 * sides + k2, i2 * sides + k);
    }
  return mesh;
}

std::vector<std::array<double, 2>> arc(double radius, double x, double z, double from, double to, int steps) {
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i <= steps; ++i) {
    const auto [sine, cosine] = portable::sincos(from + (to - from) * i / steps);
    points.push_back({x + (std::fabs(cosine) < 1e-9 ? 0 : radius * cosine), z + radius * sine});
  }
  return points;
}

bool is_inside(const std::vector<ConvexPart>& parts, const Vec3& point) {
  return std::any_of(parts.begin(), parts.end(), [&point](const ConvexPart& part) {
    const auto planes = calc_planes(calc_hull(part.points));
    return std::all_of(planes.begin(), planes.end(),
                       [&point](const HullPlane& plane) { return dot(plane.normal, point) <= plane.offset; });
  });
}

struct Hollow {
  const char* name;
  TriangleMesh mesh;
  std::vector<Vec3> free;  // points that are outside the solid
};

std::vector<Hollow> make_hollows() {
  std::vector<Hollow> hollows;
  for (const std::uint32_t sides : {8u, 24u, 64u})
    hollows.push_back({"pipe", revolve({{0.15, 0}, {0.2, 0}, {0.2, 0.5}, {0.15, 0.5}}, sides),
                       {{0, 0, 0.25}, {0.12, 0.05, 0.4}}});
  TriangleMesh turned = hollows[1].mesh;
  const Quat turn = portable::quat_from_rpy(0.4, 0.9, 1.3);
  for (Vec3f& p : turned.positions) p = Vec3f(turn.rotate(Vec3(p)) + Vec3{3, -2, 1});
  hollows.push_back({"turned pipe", turned, {turn.rotate({0.12, 0.05, 0.4}) + Vec3{3, -2, 1}}});
  hollows.push_back({"long pipe", revolve({{0.04, 0}, {0.06, 0}, {0.06, 3}, {0.04, 3}}, 24), {{0, 0, 1.5}, {0.03, 0, 2}}});
  hollows.push_back({"cup", revolve({{0, 0}, {0.1, 0}, {0.1, 0.25}, {0.08, 0.25}, {0.08, 0.02}, {0, 0.02}}, 24),
                     {{0, 0, 0.24}, {0, 0, 0.04}, {0.06, 0, 0.1}}});
  const double half = portable::kPi / 2;
  auto bowl = arc(0.2, 0, 0, -half, 0, 6);
  const auto inner = arc(0.16, 0, 0, 0, -half, 6);
  bowl.insert(bowl.end(), inner.begin(), inner.end());
  hollows.push_back({"bowl", revolve(bowl, 24), {{0, 0, -0.02}, {0, 0, -0.13}, {0.1, 0, -0.05}}});
  auto ring = arc(0.08, 0.3, 0, 0, 4 * half, 16);
  ring.pop_back();
  hollows.push_back({"torus", revolve(ring, 24), {{0, 0, 0}, {0.2, 0, 0}, {0.25, 0, 0.075}}});
  return hollows;
}

// Pipes, cups and bowls that are filled bear in mid-air what should fall into them.
TEST(Decompose, KeepsHollowsOpen) {
  DecomposeOptions options;
  options.resolution = 64;
  for (const Hollow& hollow : make_hollows()) {
    SCOPED_TRACE(hollow.name + (" of " + std::to_string(hollow.mesh.positions.size())) + " corners");
    const double volume = calc_volume_properties(hollow.mesh).volume;
    ASSERT_TRUE(is_closed(hollow.mesh) && volume > 0);
    const Decomposition made = decompose(hollow.mesh, options);
    EXPECT_LE(made.parts.size(), 64u);
    EXPECT_LT(volume_of(made.parts), 1.25 * volume) << "parts may overlap";
    EXPECT_GT(volume_of(made.parts), 0.98 * volume);
    EXPECT_LT(made.misfit.outside, 0.12 * volume);
    for (const Vec3& point : hollow.free) EXPECT_FALSE(is_inside(made.parts, point)) << point.x << ", " << point.y << ", " << point.z;
  }
  // The control: what one part holds is said.
  options.max_parts = options.most_parts = 1;
  const Hollow pipe = make_hollows()[1];
  const Decomposition one = decompose(pipe.mesh, options);
  EXPECT_TRUE(is_inside(one.parts, pipe.free[0]));
  EXPECT_GT(one.misfit.outside, 1.2 * calc_volume_properties(pipe.mesh).volume);
  EXPECT_NEAR(one.misfit.gap, 0.15, 0.02);
}

// A hole of little volume, which no limit on volume keeps.
TEST(Decompose, KeepsASmallHoleInABlockOpen) {
  const TriangleMesh block = revolve({{0.05, 0}, {0.5, 0}, {0.5, 0.3}, {0.05, 0.3}}, 16);
  DecomposeOptions options;
  options.resolution = 64;
  const Decomposition made = decompose(block, options);
  EXPECT_FALSE(is_inside(made.parts, {0, 0, 0.15}));
  EXPECT_LT(made.misfit.gap, 0.03);
}

TEST(Decompose, RoundThingsKeepTheirLengthAndVolume) {
  const double half = portable::kPi / 2;
  auto capsule = arc(0.1, 0, -0.2, -half, 0, 8);
  const auto upper = arc(0.1, 0, 0.2, 0, half, 8);
  capsule.insert(capsule.end(), upper.begin(), upper.end());
  for (const TriangleMesh& mesh : {revolve(capsule, 32), revolve(arc(0.2, 0, 0, -half, half, 16), 32)}) {
    const double volume = calc_volume_properties(mesh).volume;
    ASSERT_TRUE(is_closed(mesh) && volume > 0);
    DecomposeOptions options;
    options.resolution = 64;
    const Decomposition made = decompose(mesh, options);
    ASSERT_EQ(made.parts.size(), 1u);
    EXPECT_LE(made.parts[0].points.size(), 64u);
    EXPECT_NEAR(volume_of(made.parts) / volume, 1, 0.01);
    Aabb box;
    for (const Vec3& p : made.parts[0].points) box.include(p);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(box.min[k], mesh.bounds().min[k], 1e-6);
      EXPECT_NEAR(box.max[k], mesh.bounds().max[k], 1e-6);
    }
  }
}

// A label: thinner than the tolerance of its corners, with more of them than a part may have.
TEST(Decompose, TakesAFoilForAThinPlate) {
  const TriangleMesh foil = revolve({{0, 0}, {0.007, 0}, {0.007, 5e-5}, {0, 5e-5}}, 72);
  const Decomposition made = decompose(foil);
  ASSERT_EQ(made.parts.size(), 1u);
  Aabb box;
  for (const Vec3& p : made.parts[0].points) box.include(p);
  EXPECT_NEAR(box.max.z - box.min.z, DecomposeOptions{}.thinnest, 1e-3);
  EXPECT_NEAR(box.max.x - box.min.x, 0.014, 1e-3);
}

// Labels that lie side by side in a plane, but for what a file rounds: flat on one lattice of hulls, and not on another.
TEST(Decompose, TakesTrianglesOfNearlyOnePlane) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    RandomStream random(seed, "rounding");
    TriangleMesh mesh;
    const portable::SinCos turn = portable::sincos(0.588);
    for (const Vec3& label : {Vec3{-1.1, 0.108, 0.114}, Vec3{3, 0.29, 0.156}, Vec3{-3, 0.29, 0.156}}) {
      const auto first = std::uint32_t(mesh.positions.size());
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.surfaces.push_back(0);
      for (const auto& [along, up] : {std::pair{-1, 1}, {-1, -1}, {1, 1}}) {
        const double y = up * label.z, off = random.uniform(-1e-6, 1e-6);
        mesh.positions.push_back(
            Vec3f(Vec3(label.x + along * label.y, turn.cos * y - turn.sin * off, turn.sin * y + turn.cos * off)));
      }
    }
    const Decomposition made = decompose(mesh);
    EXPECT_GE(made.parts.size(), 1u) << "seed " << seed;
    EXPECT_GT(volume_of(made.parts), 0) << "seed " << seed;
  }
}

}  // namespace decompose_test
}  // namespace rubble
