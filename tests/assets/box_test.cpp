// Boxes made to measure: closed, worn only inwards, nowhere far from the exact box.
#include "assets/generator/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace rubble::generator {
namespace box_test {

const std::vector<Vec3> kSizes{{5, 6, 0.2}, {0.3, 6, 2}, {0.25, 0.3, 0.6}, {0.02, 0.02, 1}, {30, 20, 0.3}};

TEST(Box, EveryLevelIsClosedAndFacesOutwards) {
  for (const Vec3& size : kSizes)
    for (const TriangleMesh& mesh : make_box({size, Surface::concrete_cast, {true, false, false, true}, 7})) {
      EXPECT_TRUE(is_closed(mesh)) << size.x;
      const double exact = size.x * size.y * size.z;
      const double volume = calc_volume_properties(mesh).volume;
      EXPECT_LT(volume, exact);
      EXPECT_GT(volume, (size.x < 0.1 ? 0.7 : 0.88) * exact) << size.x << " " << size.y;
    }
}

TEST(Box, WearStaysInsideAndIsShallow) {
  for (const Vec3& size : kSizes) {
    const TriangleMesh mesh = make_box({size, Surface::concrete_cast, {true, true}, 3}).front();
    double outside = -1, deepest = 0;
    for (const Vec3f& p : mesh.positions) {
      const double beyond = std::max({std::abs(p.x) - size.x / 2, std::abs(p.y) - size.y / 2,
                                      std::abs(p.z) - size.z / 2});
      outside = std::max(outside, beyond);
      deepest = std::max(deepest, -beyond);
    }
    EXPECT_LT(outside, 2e-5) << "beyond the rounding of positions";
    EXPECT_LT(deepest, 0.031);
  }
}

TEST(Box, LevelsGetCoarserAndSeedsDiffer) {
  const BoxRecipe recipe{{4, 3, 0.2}, Surface::concrete_cast, {}, 1};
  const auto levels = make_box(recipe);
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_LT(levels[0].triangles.size(), 30000u);
  EXPECT_LT(levels[1].triangles.size() * 4, levels[0].triangles.size());
  EXPECT_LT(levels[2].triangles.size(), 120u);
  BoxRecipe other = recipe;
  other.seed = 2;
  EXPECT_TRUE(make_box(recipe)[0].positions == levels[0].positions);
  EXPECT_FALSE(make_box(other)[0].positions == levels[0].positions);
}

TEST(Box, BrokenFacesLookBroken) {
  const TriangleMesh whole = make_box({{2, 2, 0.2}, Surface::timber, {}, 1}).front();
  EXPECT_EQ(whole.surface_names, std::vector<std::string>{"timber"});
  const auto area_of = [](const TriangleMesh& mesh, const std::string& name) {
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.surface_names[mesh.surfaces[t]] != name) continue;
      const auto& c = mesh.triangles[t];
      const Vec3 a(mesh.positions[c[0]]);
      area += norm(cross(Vec3(mesh.positions[c[1]]) - a, Vec3(mesh.positions[c[2]]) - a)) / 2;
    }
    return area;
  };
  const Vec3 size{2, 2, 0.4};
  const double cast =
      area_of(make_box({size, Surface::concrete_cast, {}, 1}).front(), "concrete_fracture");
  const double broken = area_of(
      make_box({size, Surface::concrete_cast, {true}, 1}).front(), "concrete_fracture");
  EXPECT_GT(broken - cast, 0.9 * 2 * 0.4);
}

TEST(Box, MaterialsHaveTheirLooks) {
  EXPECT_EQ(surface_of_look("brick"), Surface::brick);
  EXPECT_EQ(surface_of_look("steel_galvanised"), Surface::steel_galvanised);
}

}  // namespace box_test
}  // namespace rubble::generator
