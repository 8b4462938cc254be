// A mission's terrain, walked through: what falls on it, what rays and spheres meet, what voids are.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "kernel/settling/generator.h"
#include "kernel/voids/void_space.h"
#include "tests/app/settled_mission.h"

namespace rubble::testing {
namespace terrain_test {

namespace fs = std::filesystem;

// A slope of straight lines along X: its triangles are the function itself, wherever one looks.
double height(double x) { return 1.5 + 0.1 * x + (x > 2 ? 0.2 * (x - 2) : 0); }

const char* const kMission = R"(
  local function height(x) return 1.5 + 0.1 * x + (x > 2 and 0.2 * (x - 2) or 0) end
  return rubble.mission {
    seed = 3,
    pile = {
      layers = 1, pieces_per_layer = 25, spawn_bounds = { 3, 3, 3 }, spawn_position = { 0, 0, 1 },
      terrain = rubble.terrain.from(height, { length = 12, width = 10, spacing = 0.5 }),
    },
  })";

TEST(Terrain, PiecesLieOnItAndRaysMeetItWhereTheFunctionSays) {
  const SettledMission m = settle_text(std::string(kMission) + "\n");
  EXPECT_TRUE(m.state.settled);
  EXPECT_EQ(m.state.lost, 0);
  EXPECT_GE(m.pile.spawn_bottom, height(2.5));  // not at -0.5, where the box begins
  ASSERT_EQ(m.assets.terrain().size(), 1u);
  EXPECT_EQ(m.state.pieces[0].status, PieceStatus::fixed);
  EXPECT_EQ(m.state.types.at(std::size_t(m.state.pieces[0].type)), "terrain");
  for (std::size_t i = 1; i < m.state.pieces.size(); ++i) {
    const Vec3 p = m.state.pieces[i].world_from_body.translation;
    EXPECT_GT(p.z, height(p.x) - 0.005) << i;
  }
  const PileQueries queries = m.queries();
  int met = 0;
  for (double x = -5.7; x < 5.8; x += 0.313) {
    for (double y = -4.7; y < 4.8; y += 0.417) {
      const auto hit = queries.cast_ray({x, y, 20}, {0, 0, -1}, 100);
      ASSERT_TRUE(hit);
      if (hit->piece != 0) continue;
      ++met;
      EXPECT_NEAR(20 - hit->distance, height(x), 2e-6) << x << ", " << y;
      EXPECT_GT(hit->normal.z, 0.9);
      EXPECT_EQ(queries.clearance({x, y, height(x) - 0.3}), 0) << x;
      EXPECT_EQ(queries.find_overlaps({x, y, height(x) + 0.1}, 0.11).front(), 0);
    }
  }
  EXPECT_GT(met, 400);
  EXPECT_EQ(queries.cast_ray({9, 0, 5}, {0, 0, -1}, 100)->piece, kGroundPiece);  // beyond its edge
  const auto nearest = queries.find_closest({-5.5, 3, height(-5.5) + 0.2}, 1);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance, 0.2 / std::sqrt(1.01), 1e-5);
}

TEST(Terrain, BelowItAllIsSolidAndTheMapOfVoidsIsAroundThePile) {
  const SettledMission m = settle_text(kMission);
  const std::vector<TriangleMesh> collision = make_collision_meshes(m.assets.types);
  std::vector<const TriangleMesh*> meshes;
  for (const TriangleMesh& mesh : collision) meshes.push_back(&mesh);
  VoidSpaceOptions options;
  options.voxel = 0.1;
  options.rolling_radius = 0.5;
  options.threads = 1;
  options.scenery = m.assets.terrain();
  const VoidSpace space = calc_void_space(m.state, meshes, options);
  EXPECT_LT(space.grid.size[1] * space.grid.voxel, 8);  // the terrain is 10 m wide
  std::size_t below = 0, above = 0;
  for (std::size_t i = 0; i < space.grid.count(); ++i) {
    const Vec3 centre = space.grid.centre(i);
    if (std::abs(centre.x) > 5.9) continue;
    if (centre.z < height(centre.x) - 1e-3) {
      ++below;
      EXPECT_EQ(space.kind[i], CellKind::solid) << centre.x << " " << centre.z;
    } else if (space.kind[i] != CellKind::solid) {
      ++above;
    }
  }
  EXPECT_GT(below, 1000u);
  EXPECT_GT(above, 1000u);
}

// The same as a file: a mesh on its side in centimetres.
TEST(Terrain, AMeshOfAFileIsTerrainToo) {
  const fs::path folder = fs::path(::testing::TempDir()) / "terrain_mesh";
  fs::create_directories(folder);
  std::ofstream(folder / "site.obj") << "v -600 100 600\nv 600 100 600\nv 600 100 -600\nv -600 100 -600\n"
                                        "f 1 2 3\nf 1 3 4\n";
  std::ofstream(folder / "m.lua")
      << "return rubble.mission { pile = { layers = 1, pieces_per_layer = 12,\n"
         "  spawn_bounds = { 3, 3, 3 }, spawn_position = { 0, 0, 3 },\n"
         "  terrain = { file = 'site.obj', metres_per_unit = 0.01, up = 'y' } } }\n";
  const Mission mission = load_mission((folder / "m.lua").string());
  const AssetLibrary assets = load_assets(mission, {});
  ASSERT_EQ(assets.warnings.size(), 1u);
  EXPECT_NE(assets.warnings[0].find("not closed"), std::string::npos);
  EXPECT_EQ(assets.contents.back().pack, "terrain of the mission");
  SettleOptions options = mission.scenario.settle;
  options.threads = 1;
  const PileState state = settle_pile(generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets)), options);
  EXPECT_TRUE(state.settled);
  for (std::size_t i = 1; i < state.pieces.size(); ++i) {
    const Vec3 p = state.pieces[i].world_from_body.translation;
    if (std::abs(p.x) < 6 && std::abs(p.y) < 6) {
      EXPECT_GT(p.z, 0.995) << i;
    }
  }
  // Again from a provenance: the file is looked for where it was, and must be the same.
  Provenance provenance = make_provenance(RunKind::settle, mission, {});
  provenance.assets = assets.contents;
  EXPECT_EQ(load_assets(provenance, assets.folders).contents.back().sha256,
            assets.contents.back().sha256);
  EXPECT_THROW(load_assets(provenance, {}), InputError);
  std::ofstream(folder / "site.obj", std::ios::app) << "v 0 0 0\nf 1 2 5\n";
  EXPECT_THROW(load_assets(provenance, assets.folders), InputError);
  fs::remove_all(folder);
}

std::string error_of(const std::string& terrain) {
  try {
    const Mission mission =
        load_mission_text("return rubble.mission { pile = { terrain = " + terrain + " } }", "m.lua");
    load_assets(mission, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Terrain, MistakesAreNamed) {
  EXPECT_NE(error_of("{ columns = 2, rows = 2, heights = { 1, 2, 3 } }").find("not a whole grid"),
            std::string::npos);
  EXPECT_NE(error_of("{ columns = 2, rows = 2, heights = { 1, 2, 3, -1 } }").find("below the ground"),
            std::string::npos);
  EXPECT_NE(error_of("{ file = 'nowhere.obj' }").find("no such file"), std::string::npos);
  EXPECT_NE(error_of("{ file = 'a.obj', columns = 2, rows = 2, heights = { 1, 2, 3, 1 } }")
                .find("contradicts"),
            std::string::npos);
  EXPECT_NE(error_of("{ columns = 2, rows = 2, heights = { 1, 2, 3, 1 }, look = 'marble' }")
                .find("no such look"),
            std::string::npos);
  EXPECT_NE(error_of("rubble.terrain.from(function() return -1 end)").find("not a height"),
            std::string::npos);
  EXPECT_NE(error_of("rubble.terrain.from(function() return 1 end, { spacing = 0.05 })")
                .find("2 to 512"),
            std::string::npos);
}

}  // namespace terrain_test
}  // namespace rubble::testing
