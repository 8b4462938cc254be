// The generator's tools against closed forms, and its promise of the same bytes every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "assets/generator/asset.h"
#include "assets/generator/noise.h"
#include "assets/generator/polytope.h"
#include "assets/generator/shapes.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "tests/assets/obj_reader.h"

namespace rubble::generator {
namespace generator_test {

Wear no_wear() { return {0, 0.1, 0.02, 0, 1e-6, 0, 0.05}; }

double volume_of(const SurfaceMesh& mesh) {
  return calc_volume_properties(finish(mesh, 40)).volume;
}

TEST(Polytope, CornersOfABox) {
  const std::vector<Vec3> corners = corners_of(box_cell({-1, -2, -3}, {1, 2, 3}, Surface::brick));
  EXPECT_EQ(corners.size(), 8u);
  for (const Vec3& c : corners) EXPECT_EQ(std::fabs(c.x * c.y * c.z), 6);
  EXPECT_NEAR(hull_volume(corners), 48, 1e-12);
  EXPECT_EQ(hull_faces(corners).size(), 6u);
}

TEST(Polytope, UnboundedCellIsRefused) {
  Cell cell = box_cell({-1, -1, -1}, {1, 1, 1}, Surface::brick);
  cell.resize(2);
  EXPECT_THROW(corners_of(cell), RunError);
}

TEST(Polytope, InnerAndEdgePointsAreNoCorners) {
  std::vector<Vec3> points = box_corners({0, 0, 0}, {1, 1, 1});
  points.push_back({0.5, 0.5, 0.5});
  points.push_back({0.5, 0, 0});
  for (const Polygon& face : hull_faces(points)) {
    EXPECT_EQ(face.corners.size(), 4u);
    for (const int c : face.corners) EXPECT_LT(c, 8);
  }
}

TEST(Marching, UnwornBoxHasItsVolume) {
  const Solid solid{
      {box_cell({-0.2, -0.1, -0.05}, {0.2, 0.1, 0.05}, Surface::brick)}, {}, no_wear(), 1};
  const SurfaceMesh mesh = mesh_solid(solid, 0.01);
  EXPECT_TRUE(is_closed(finish(mesh, 40)));
  EXPECT_NEAR(volume_of(mesh), 0.008, 0.008 * 0.01);  // edges are cut at the grid's size
}

TEST(Marching, CylinderHasItsVolume) {
  Cell cell = box_cell({-0.3, -0.2, -0.2}, {0.3, 0.2, 0.2}, Surface::concrete_cast);
  cell.push_back({{1, 0, 0}, 0.1, Surface::concrete_cast, true});
  const Solid solid{{cell}, {}, no_wear(), 1};
  const double expected = portable::kPi * 0.01 * 0.6;
  EXPECT_NEAR(volume_of(mesh_solid(solid, 0.008)), expected, 0.01 * expected);
}

TEST(Marching, WearOnlyRemoves) {
  Solid solid{
      {box_cell({-0.2, -0.1, -0.05}, {0.2, 0.1, 0.05}, Surface::concrete_fracture)}, {}, {}, 7};
  const SurfaceMesh mesh = mesh_solid(solid, 0.01);
  for (const Vec3& p : mesh.positions) {
    ASSERT_LE(std::fabs(p.x), 0.2 + 1e-9);
    ASSERT_LE(std::fabs(p.y), 0.1 + 1e-9);
    ASSERT_LE(std::fabs(p.z), 0.05 + 1e-9);
  }
  EXPECT_LT(volume_of(mesh), 0.0078);
  EXPECT_GT(volume_of(mesh), 0.0065);
}

TEST(Decimate, KeepsABoxWithFewTriangles) {
  const Solid solid{
      {box_cell({-0.2, -0.1, -0.05}, {0.2, 0.1, 0.05}, Surface::brick)}, {}, no_wear(), 1};
  const SurfaceMesh fine = mesh_solid(solid, 0.01);
  const SurfaceMesh coarse = decimate(fine, {60, 1e9});
  EXPECT_LE(coarse.triangles.size(), 60u);
  EXPECT_TRUE(is_closed(finish(coarse, 40)));
  EXPECT_NEAR(volume_of(coarse), volume_of(fine), 0.01 * volume_of(fine));
}

TEST(Decimate, ObeysTheLongestEdge) {
  const Solid solid{
      {box_cell({-0.2, -0.1, -0.05}, {0.2, 0.1, 0.05}, Surface::brick)}, {}, no_wear(), 1};
  const SurfaceMesh mesh = decimate(mesh_solid(solid, 0.01), {12, 0.05});
  EXPECT_GT(mesh.triangles.size(), 12u);
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_LE(distance(mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]), 0.05);
    }
  }
}

TEST(Bar, TubeHasTheVolumeOfTheRod) {
  const Bar bar{{{0, 0, 0}, {0.5, 0, 0}}, 0.01, 0, true};
  const double expected = 0.5 * portable::kPi * 0.0001;
  const SurfaceMesh mesh = mesh_bar(bar, 8, 0.04);
  EXPECT_TRUE(is_closed(finish(mesh, 40)));
  EXPECT_NEAR(volume_of(mesh), expected, 1e-3 * expected);
}

TEST(Bar, BuriedLengthHasNoPart) {
  const Bar bar{{{0, 0, 0}, {0.5, 0, 0}}, 0.01, 0.2, true};
  const auto parts = bar_parts(bar);
  ASSERT_EQ(parts.size(), 1u);
  for (const Vec3& p : parts[0]) EXPECT_GE(p.x, 0.2 - 1e-12);
}

TEST(Noise, StaysInRangeAndVaries) {
  RandomStream random(5, "noise");
  double low = 9, high = -9, grain_low = 9, grain_high = -9;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.direction() * random.uniform(0, 50);
    low = std::min(low, fractal_noise(p, 3, 1)), high = std::max(high, fractal_noise(p, 3, 1));
    const double grain = grain_noise(p, 1);
    grain_low = std::min(grain_low, grain), grain_high = std::max(grain_high, grain);
  }
  EXPECT_GE(low, -1.2);
  EXPECT_LE(low, -0.4);
  EXPECT_GE(high, 0.4);
  EXPECT_LE(high, 1.2);
  EXPECT_EQ(grain_low, 0);
  EXPECT_GT(grain_high, 0.95);
  EXPECT_LE(grain_high, 1);
}

TEST(Noise, IsContinuousAcrossCells) {
  for (int i = 0; i < 200; ++i) {
    const double y = 0.37 * i, step = 1e-7;
    const Vec3 below{3 - step, y, 0.2}, above{3 + step, y, 0.2};
    EXPECT_NEAR(gradient_noise(below, 3), gradient_noise(above, 3), 1e-5);
    EXPECT_NEAR(grain_noise(below, 3), grain_noise(above, 3), 1e-5);
  }
}

// Hash over names and contents, in the order of the names.
std::string hash_of_folder(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names)
    text += name + " " + sha256_of_file(folder + "/" + name) + "\n";
  return sha256(text);
}

std::string text_of(const Pack& pack, const std::string& folder, const std::string& file) {
  std::filesystem::remove_all(folder);
  write_pack(pack, folder);
  return test::read_text(folder + "/" + file);
}

// A few pieces of each pack, one with a warp, one with sheets and one with bars among them.
TEST(Determinism, TheSameBytesAgain) {
  const std::string again = std::string(RUBBLE_SCRATCH_DIR) + "/pack_again";
  const std::vector<std::vector<std::string>> some = {{"concrete", "half_brick", "chunk_bars_1"},
                                                      {"residential", "drywall_shard", "stud_broken"},
                                                      {"parking", "guard_rail_post", "guard_rail_bent"},
                                                      {"bridge", "rebar_tangle", "steel_girder_torn"}};
  for (const auto& names : some) {
    Pack pack = make_pack(names[0]);
    auto& recipes = pack.recipes;
    recipes.erase(std::remove_if(recipes.begin(), recipes.end(),
                                 [&](const Recipe& r) {
                                   return std::find(names.begin(), names.end(), r.name) ==
                                          names.end();
                                 }),
                  recipes.end());
    ASSERT_EQ(recipes.size(), 2u) << names[0];
    for (std::size_t i = 1; i < names.size(); ++i) {
      for (const char* file : {".lod0.obj", ".lod2.obj", ".parts.obj"}) {
        EXPECT_EQ(sha256(text_of(pack, again, names[i] + file)),
                  sha256_of_file(std::string(RUBBLE_ASSETS_DIR) + "/" + names[0] + "/" + names[i] + file))
            << names[i] << file;
      }
    }
  }
}

class Golden : public ::testing::TestWithParam<std::string> {};

// Changes when a piece does; a difference with unchanged sources means lost determinism.
TEST_P(Golden, TheSameBytesOnEveryMachine) {
  const std::string hash = hash_of_folder(std::string(RUBBLE_ASSETS_DIR) + "/" + GetParam());
  EXPECT_EQ(hash, test::read_text(std::string(RUBBLE_SOURCE_DIR) + "/tests/assets/" + GetParam() +
                                  ".sha256")
                      .substr(0, 64));
}

INSTANTIATE_TEST_SUITE_P(Packs, Golden, ::testing::ValuesIn(pack_names()),
                         [](const auto& test) { return test.param; });

TEST(Determinism, AnotherSeedGivesAnotherPiece) {
  Solid solid{
      {box_cell({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, Surface::concrete_fracture)}, {}, {}, 1};
  const SurfaceMesh one = mesh_solid(solid, 0.02);
  solid.seed = 2;
  EXPECT_NE(one.positions, mesh_solid(solid, 0.02).positions);
}

}  // namespace generator_test
}  // namespace rubble::generator
