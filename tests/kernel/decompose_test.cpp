// Meshes cut into convex parts, against shapes whose parts and volumes are known.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/geometry/decompose.h"
#include "kernel/geometry/decompose_voxels.h"
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
  const auto parts = decompose(box);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(volume_of(parts), 0.03, 1e-6);
  EXPECT_EQ(parts[0].points.size(), 8u);
}

// An L and a table: the parts are the boxes they were made of, in volume and number.
TEST(Decompose, FindsTheBoxesOfAnL) {
  TriangleMesh l;
  add_box(l, {0, 0, 0}, {1, 0.3f, 0.2f});
  add_box(l, {0, 0, 0.2f}, {0.2f, 0.3f, 1});
  const auto parts = decompose(l);
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
  const auto parts = decompose(beam);
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
    const auto parts = decompose(turned);
    EXPECT_EQ(parts.size(), 2u);
    EXPECT_NEAR(share_beyond(turned, parts), 0, 1e-5);
  }
  // The control: with a slanted end it is no union of boxes, and the parts only come near it.
  const TriangleMesh slanted = make_l_prism(0.1f);
  EXPECT_GT(std::fabs(share_beyond(slanted, decompose(slanted))), 1e-5);
}

TEST(Decompose, CutsStairsOfOneSurfaceIntoTheirSteps) {
  const TriangleMesh stairs = make_prism(
      {{0, 0}, {0.9f, 0}, {0.9f, 0.2f}, {0.6f, 0.2f}, {0.6f, 0.4f}, {0.3f, 0.4f}, {0.3f, 0.6f}, {0, 0.6f}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}}, 1.0f);
  const auto steps = decompose(stairs);
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
  const auto parts = decompose(table);
  EXPECT_GE(parts.size(), 5u);
  EXPECT_LE(parts.size(), 16u);
  EXPECT_NEAR(volume_of(parts), expected, 0.15 * expected);
  // The negative control: one part would hold ten times as much.
  DecomposeOptions one;
  one.max_parts = 1;
  EXPECT_GT(volume_of(decompose(table, one)), 5 * expected);
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
  const auto parts = decompose(ring, options);
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
  const auto parts = decompose(sheet);
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
  const auto a = decompose(l), b = decompose(l);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].points, b[i].points);
}

}  // namespace decompose_test
}  // namespace rubble
