// What a camera or another sensor may not be inside of.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "app/assets/asset_library.h"
#include "app/planning/solid_matter.h"
#include "app/surroundings/pile_surroundings.h"
#include "kernel/geometry/fine_shapes.h"
#include "scripting/mission.h"
#include "tests/voids/void_scenes.h"

namespace rubble::testing {
namespace solid_matter_test {

// A cube of 1 m about the origin.
TriangleMesh make_cube() { return make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}); }

// As a house is that nothing closes below.
TriangleMesh make_open_cube() {
  TriangleMesh mesh = make_cube();
  const auto is_low = [&](const std::array<std::uint32_t, 3>& corners) {
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t i) { return mesh.positions[i].z < 0; });
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), is_low), mesh.triangles.end());
  return mesh;
}

// Seen from above; unit: m.
TriangleMesh make_sheet(double half, double height) {
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    mesh.positions.push_back(Vec3f(Vec3{x * half, y * half, height}));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// One thing each, 5 m apart along X, 2 m above the ground; leaves at 15 m; uneven soil about the origin.
PileState make_neighbours() {
  Surroundings around;
  const auto add = [&](SurroundingKind kind, TriangleMesh mesh, const Vec3& position, bool leafy = false) {
    auto made = std::make_shared<SurroundingMesh>();
    made->levels.push_back(std::move(mesh)), made->leafy = leafy;
    around.things.push_back({kind, std::uint32_t(around.meshes.size()), Pose{{}, position}, 2});
    around.meshes.push_back(made);
  };
  add(SurroundingKind::building, make_open_cube(), {5, 0, 2});
  add(SurroundingKind::vehicle, make_cube(), {10, 0, 2});
  add(SurroundingKind::tree, make_cube(), {15, 0, 2}, true);
  add(SurroundingKind::soil, make_sheet(1, 0.1), {});  // 0.2 m high: it is twice as large
  PileState pile;
  pile.surroundings = std::make_shared<Surroundings>(std::move(around));
  return pile;
}

TEST(SolidMatter, IsOfSurroundingsWhatHasAnInside) {
  const AssetLibrary none;
  const PileState pile = make_neighbours();
  const SolidMatter solid(none, pile);
  const struct {
    Vec3 point;
    const char* inside;  // null: nothing
  } cases[] = {
      {{5.3, 0.2, 2.1}, "inside surroundings (building)"},
      {{5.9, 0, 2.9}, "inside surroundings (building)"},
      {{6.1, 0, 2}, nullptr},
      {{5, 0, 3.1}, nullptr},
      {{10, 0.9, 2}, "inside surroundings (vehicle)"},
      {{15, 0, 2}, nullptr},
      {{0, 1.5, 0.19}, "below the ground"},
      {{0, 1.5, 0.21}, nullptr},
      {{0, 2.5, 0.01}, nullptr},
      {{0, 2.5, -0.01}, "below the ground"},
  };
  for (const auto& c : cases) {
    const auto warning = solid.warn_of("it", {c.point});
    EXPECT_EQ(warning.has_value(), c.inside != nullptr) << c.point.x << " " << c.point.y << " " << c.point.z;
    if (c.inside && warning) {
      EXPECT_EQ(warning->rfind("it is " + std::string(c.inside) + " at frame 0", 0), 0u) << *warning;
    }
  }
}

TEST(SolidMatter, IsFinesWhereTheirHostIs) {
  const AssetLibrary none;
  PileState pile;
  pile.fines.surfaces = {"dust"};
  pile.fines.sheets.push_back({FineKind::dust, -1, 0, make_box({-0.5, -0.5, -0.1}, {0.5, 0.5, 0.1})});
  heap_fines(pile.fines);
  const SolidMatter solid(none, pile);
  EXPECT_EQ(solid.warn_of("it", {{0, 0, 0.3}, {0, 0, 0.05}, {2, 0, 0.05}, {0.4, 0, 0.09}}),
            "it is inside fines (dust) at frame 1, {0.00, 0.00, 0.05}, and inside something or below the ground at 2 of 4 "
            "frames: move its path, or fly with trajectory.plan = \"avoid\"");
  EXPECT_EQ(solid.warn_of("it", {{0, 0, 0.3}, {2, 0, 0.05}}), std::nullopt);
}

// The street itself, not only what a test makes of it: about the middle of every house is its inside, and beside it is not.
TEST(SolidMatter, HoldsTheHousesOfAStreet) {
  const Mission mission = load_mission_text(
      "return rubble.mission { pile = { layers = 0 }, surroundings = { type = 'street', reach = 60 } }", "street.lua");
  const AssetLibrary none;
  PileState pile;
  lay_surroundings(mission.scenario, none, pile);
  const SolidMatter solid(none, pile);
  int houses = 0;
  for (const SurroundingThing& thing : pile.surroundings->things) {
    if (thing.kind != SurroundingKind::building) continue;
    const Aabb box = pile.surroundings->meshes[thing.mesh]->levels.front().bounds();
    const auto is_in_a_house = [&](double u, double v) {  // shares of the box, from its low corner
      const Vec3 size = box.max - box.min;
      const Vec3 at = thing.world_from_mesh * (Vec3{box.min.x + u * size.x, box.min.y + v * size.y, 1.5} * thing.scale);
      const auto warning = solid.warn_of("it", {at});
      return warning && warning->find("inside surroundings (building)") != std::string::npos;
    };
    for (const double u : {0.25, 0.5, 0.75})
      for (const double v : {0.25, 0.5, 0.75}) EXPECT_TRUE(is_in_a_house(u, v)) << "house " << houses << ": " << u << " " << v;
    for (const double u : {0.25, 0.5, 0.75})  // before the house and behind it; others stand to its right and left
      for (const double v : {-0.1, 1.1}) EXPECT_FALSE(is_in_a_house(u, v)) << "house " << houses << ": " << u << " " << v;
    ++houses;
  }
  EXPECT_GT(houses, 4);
}

}  // namespace solid_matter_test
}  // namespace rubble::testing
