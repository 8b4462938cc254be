// Every collapse mode, bare and settled, against the closed form of its void's cross-section.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/measures/pile_section.h"
#include "app/provenance/provenance.h"
#include "tests/app/settled_mission.h"

namespace rubble::testing {
namespace collapse_test {

constexpr double kDegree = 3.14159265358979323846 / 180;
const std::string kBare = "debris = { layers = 0 }, ";

SettledMission settle_mode(const std::string& mode, const std::string& parameters) {
  return settle_text("return rubble.mission { seed = 3, pile = rubble.collapse." + mode + "{ " +
                     kBare + parameters + " } }");
}

void expect_close(double found, double expected) {
  EXPECT_NEAR(found, expected, 0.1 * expected);
  EXPECT_GT(expected, 0);
}

struct Triangle {
  double length, height;
  int storeys;
};

TEST(Collapse, LeanToHasOneTriangle) {
  for (const Triangle& t : {Triangle{5, 2, 1}, {4, 1, 1}, {3, 2.4, 1}, {5, 2, 3}}) {
    const SettledMission m = settle_mode(
        "lean_to", "length = " + std::to_string(t.length) + ", height = " +
                       std::to_string(t.height) + ", storeys = " + std::to_string(t.storeys));
    EXPECT_TRUE(m.state.settled);
    EXPECT_LT(m.largest_move(), 0.15) << t.length << " " << t.height;
    const double reach = std::sqrt(t.length * t.length - t.height * t.height);
    for (const double y : {-2.5, 0.0, 2.5})
      expect_close(calc_free_section(m.queries(), 0, reach, y), t.height * reach / 2);
  }
}

// What `rubble cutaway` shows as cut is what is there: the free part of the picture is the closed form.
TEST(Collapse, TheCutShowsTheTriangle) {
  const SettledMission m = settle_mode("lean_to", "length = 5, height = 2");
  const PileSection section = cut_pile(build_scene(m.mission.scenario, m.assets, m.state), 0);
  ASSERT_EQ(section.faces.size(), 2u) << "the stub and the slab";
  const double reach = std::sqrt(21.0), step = 0.01;
  double solid = 0, all = 0;
  for (double z = step / 2; z < 2; z += step) {
    const double slope = reach * (1 - z / 2);  // of the slab's lower face
    all += slope * step;
    for (const CutFace& face : section.faces) {
      const std::vector<double> x = find_insides(face, z);
      for (std::size_t i = 0; i + 1 < x.size(); i += 2)
        solid += step * std::max(0.0, std::min(x[i + 1], slope) - std::max(x[i], 0.0));
    }
  }
  expect_close(all - solid, reach);
  EXPECT_GT(section.x1, 4.5);
  EXPECT_NEAR(section.top, 2.2, 0.3);
}

TEST(Collapse, ACutMissesWhatIsInFrontOfIt) {
  const SettledMission m = settle_mode("lean_to", "length = 5, height = 2, width = 4");
  const Scene scene = build_scene(m.mission.scenario, m.assets, m.state);
  EXPECT_TRUE(cut_pile(scene, 5).scene.instances.empty());
  const PileSection whole = cut_pile(scene, -5);
  EXPECT_EQ(whole.scene.instances.size(), scene.instances.size());
  EXPECT_TRUE(whole.faces.empty());
  for (const SceneInstance& left : cut_pile(scene, 0.5).scene.instances)
    EXPECT_GE((left.world_from_body * Vec3(cut_pile(scene, 0.5).scene.meshes[left.mesh]
                                               ->levels[0].bounds().min)).y, 0.5 - 1e-5);
}

// The check must see a slab that fell.
TEST(Collapse, TheSectionOfASlabOnTheFloorIsNoTriangle) {
  const SettledMission m = settle_text(
      "return rubble.mission { pile = { layers = 0, placed = { { box = { 5, 6, 0.2 }, "
      "position = { 2.5, 0, 0.1 }, fixed = false } } } }");
  EXPECT_LT(calc_free_section(m.queries(), 0, 4.6, 0), 0.01);
}

TEST(Collapse, CantileverHasAnOpenWedge) {
  const double length = 4, height = 2.6, droop = 20 * kDegree;
  const SettledMission m = settle_mode(
      "cantilever", "length = 4, height = 2.6, droop_deg = 20, storeys = 2, storey_height = 3");
  const double reach = length * std::cos(droop), drop = length * std::sin(droop);
  expect_close(calc_free_section(m.queries(), 0, reach, 0), reach * (height - drop / 2));
  const auto tip = m.queries().cast_ray({reach - 0.05, 0, 0.001}, {0, 0, 1}, 10);
  ASSERT_TRUE(tip);
  EXPECT_NEAR(tip->distance, height - drop, 0.05);
  EXPECT_FALSE(m.queries().cast_ray({reach + 0.3, 0, 0.001}, {0, 0, 1}, 10)) << "not open";
}

TEST(Collapse, VShapeHasTwoTriangles) {
  for (const int storeys : {1, 2}) {
    const SettledMission m = settle_mode(
        "v_shape", "length = 8, height = 1.8, storeys = " + std::to_string(storeys));
    EXPECT_TRUE(m.state.settled);
    EXPECT_LT(m.largest_move(), 0.15);
    const double reach = std::sqrt(16 - 1.8 * 1.8);
    expect_close(calc_free_section(m.queries(), -4, 0, 0), 1.8 * reach / 2);
    expect_close(calc_free_section(m.queries(), 0, 4, 0), 1.8 * reach / 2);
  }
}

TEST(Collapse, AFrameHasTwoTriangles) {
  for (const int storeys : {1, 2}) {
    const SettledMission m = settle_mode(
        "a_frame", "length = 9, height = 2, storeys = " + std::to_string(storeys));
    EXPECT_TRUE(m.state.settled);
    EXPECT_LT(m.largest_move(), 0.15);
    const double reach = std::sqrt(4.5 * 4.5 - 4);
    expect_close(calc_free_section(m.queries(), -5, -0.15, 0), 2 * reach / 2);
    expect_close(calc_free_section(m.queries(), 0.15, 5, 0), 2 * reach / 2);
  }
}

TEST(Collapse, PancakeIsAsHighAsItsFloorsAndGaps) {
  for (const double tilt : {0.0, 3.0}) {
    const SettledMission m = settle_mode(
        "pancake", "storeys = 4, gap = 0.5, thickness = 0.2, tilt_deg = " + std::to_string(tilt));
    EXPECT_TRUE(m.state.settled);
    EXPECT_LT(m.largest_move(), 0.2);
    const PileQueries queries = m.queries();
    const auto top = queries.cast_ray({0.3, 0.2, 20}, {0, 0, -1}, 30);
    ASSERT_TRUE(top);
    expect_close(20 - top->distance, 4 * 0.7);
    // Each gap, along a vertical line in the middle.
    double from = 0.001;
    for (int storey = 0; storey < 4; ++storey) {
      const auto ceiling = queries.cast_ray({0.01, 0.01, from}, {0, 0, 1}, 10);
      ASSERT_TRUE(ceiling);
      expect_close(ceiling->distance, 0.5);
      from = ceiling->point.z + 0.2 / std::cos(tilt * kDegree) + 0.004;
    }
  }
}

TEST(Collapse, InclinedHasStackedWedges) {
  const double length = 5, bearing = 0.1, dip = 20 * kDegree, step = 4 * kDegree;
  const SettledMission m =
      settle_mode("inclined", "length = 5, dip_deg = 20, spread_deg = 8, storeys = 3");
  EXPECT_TRUE(m.state.settled);
  EXPECT_LT(m.largest_move(), 0.1);
  const PileQueries queries = m.queries();
  const double clear = length - bearing, foot = clear * std::cos(dip);
  expect_close(calc_free_section(queries, 0, foot, 0), clear * clear * std::sin(2 * dip) / 4);
  // Wedges: between a floor's upper face and the next one's lower face, from the hinge to the end.
  const double from = 0.25;  // clear of the stubs
  const double run = foot - from;
  for (int k = 1; k < 3; ++k) {
    double area = 0;
    for (int i = 0; i < 500; ++i) {
      const double x = from + run * (i + 0.5) / 500;
      const auto seen = queries.cast_ray({x, 0, 0.001}, {0, 0, 1}, 20);
      ASSERT_TRUE(seen);
      Vec3 p = seen->point;
      for (int floor = 0; floor < k; ++floor) {
        if (floor > 0) p = queries.cast_ray(p + Vec3{0, 0, 1e-6}, {0, 0, 1}, 20).value().point;
        p = queries.cast_ray(p + Vec3{0, 0, 1e-6}, {0, 0, 1}, 20).value().point;  // through it
      }
      const auto next = queries.cast_ray(p + Vec3{0, 0, 1e-6}, {0, 0, 1}, 20);
      ASSERT_TRUE(next);
      area += (next->distance + 1e-6) * run / 500;
    }
    const double low = dip + (k - 1) * step, high = dip + k * step;
    expect_close(area, run * run / 2 * (std::tan(high) - std::tan(low)));
  }
}

TEST(Collapse, LeanOverKeepsItsRooms) {
  const SettledMission m = settle_mode(
      "lean_over", "length = 4, storey_height = 2.6, lean_deg = 35, storeys = 2, thickness = 0.2");
  const PileQueries queries = m.queries();
  // In the frame of the upright building, turned about Y at the origin.
  const double lean = 35 * kDegree;
  const auto turned = [&](double x, double z) {
    return Vec3{x * std::cos(lean) + z * std::sin(lean), 0, z * std::cos(lean) - x * std::sin(lean)};
  };
  for (const double floor : {0.2, 0.2 + 2.8}) {
    int free = 0;
    for (int i = 0; i < 60; ++i)
      for (int k = 0; k < 60; ++k)
        free += queries.clearance(turned(-4.3 + 4.2 * (i + 0.5) / 60, floor - 0.1 + 2.8 * (k + 0.5) / 60),
                                  0.01) > 0;
    expect_close(free * (4.2 / 60) * (2.8 / 60), 4 * 2.6);
  }
}

TEST(Collapse, CurtainComesDownAtTheFootOfTheWall) {
  const SettledMission m = settle_mode("curtain", "length = 3, storey_height = 2.6, missing = 0");
  double inside = 0, all = 0, highest = 0;
  for (const PieceState& piece : m.state.pieces) {
    if (piece.status == PieceStatus::fixed) continue;
    const Vec3& p = piece.world_from_body.translation;
    all += 1;
    inside += p.x > 0 && p.x < 2.6 && std::abs(p.y) < 2.6;
    highest = std::max(highest, p.z);
  }
  EXPECT_EQ(all, 105) << "3 x 2.6 m of blocks of 0.39 x 0.19 m";
  EXPECT_GT(inside / all, 0.9);
  EXPECT_LT(highest, 0.7 * 2.6);
  EXPECT_TRUE(m.state.settled);
}

TEST(Collapse, CulvertsAreTheirBores) {
  for (const std::string kind : {"pipe", "box"}) {
    const SettledMission m =
        settle_mode("culvert", "bore = 0.9, rows = 2, segments = 3, kind = '" + kind + "'");
    const PileQueries queries = m.queries();
    const PlacedItem& item = m.mission.scenario.pile.placed[1];
    int free = 0;
    const int n = 100;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        const Vec3 out{0.05, 0.94 * ((i + 0.5) / n - 0.5), 0.94 * ((k + 0.5) / n - 0.5)};
        if (kind == "pipe" && norm(out) > 0.5) continue;  // outside the pipe
        free += queries.clearance(item.position + out, 0.01) > 0;
      }
    // A box's haunches (a twelfth of the bore) are filled.
    const double area = kind == "pipe" ? kDegree * 180 * 0.45 * 0.45
                                       : 0.81 - 2 * (0.9 / 12) * (0.9 / 12);
    expect_close(free * (0.94 / n) * (0.94 / n), area);
    // Straight through the whole row.
    EXPECT_FALSE(queries.cast_ray(item.position - Vec3{5, 0, 0}, {1, 0, 0}, 10));
  }
}

TEST(Collapse, HeapIsWhatThePileKeysSay) {
  const auto json = [](const std::string& pile) {
    return scenario_to_json(load_mission_text("return rubble.mission { pile = " + pile + " }", "m.lua").scenario);
  };
  EXPECT_EQ(json("rubble.collapse.heap { layers = 2, length = 5, width = 4, height = 3 }"),
            json("{ layers = 2, spawn_bounds = { 5, 4, 3 }, spawn_position = { 0, 0, 2.5 } }"));
}

TEST(Collapse, FreePiecesMoveAndTurnTogether) {
  const Scenario s = load_mission_text(
                         "return rubble.mission { pile = rubble.collapse.free { yaw_deg = 90, position = { 1, 2, 0 }, "
                         "pieces = { { box = { 2, 1, 1 }, position = { 3, 0, 0.5 }, rpy_deg = { 0, 10, 300 } } } } }",
                         "m.lua")
                         .scenario;
  ASSERT_EQ(s.pile.placed.size(), 1u);
  EXPECT_NEAR(distance(s.pile.placed[0].position, {1, 5, 0.5}), 0, 1e-12);
  EXPECT_EQ(s.pile.placed[0].rpy_deg, Vec3(0, 10, 30));
  EXPECT_EQ(s.pile.layers, 2);
}

// What every mode has: a cover of debris that stays off the voids, and a place in the world.
TEST(Collapse, DebrisCoversWhatHasSettled) {
  const SettledMission m = settle_text(
      "return rubble.mission { seed = 5, pile = rubble.collapse.lean_to { position = { 3, -2, 0 }, "
      "yaw_deg = 180, debris = { layers = 2, pieces_per_layer = 60 } } }");
  EXPECT_TRUE(m.state.settled);
  int debris = 0, on_top = 0;
  const PileQueries queries = m.queries();
  for (const PieceState& piece : m.state.pieces) {
    if (piece.layer < 0 || piece.status == PieceStatus::lost) continue;
    ++debris;
    const Vec3& p = piece.world_from_body.translation;
    const bool under = p.x < 3 && p.x > -1.3 && std::abs(p.y + 2) < 2.8 &&
                       p.z < 2.0 * (p.x + 1.6) / 4.6 - 0.3;
    on_top += !under;
  }
  EXPECT_EQ(debris, 120);
  EXPECT_GT(on_top, 110);
  expect_close(calc_free_section(queries, 3 - 4.5, 3, -2), 2 * std::sqrt(21.0) / 2);
}

// A run is had again from its provenance alone: its boxes, too.
TEST(PlacedBoxes, AreMadeAgainFromARecipe) {
  const SettledMission m = settle_mode("lean_to", "");
  Provenance provenance = make_provenance(RunKind::settle, m.mission, {});
  provenance.assets = m.assets.contents;
  const AssetLibrary again = load_assets(provenance, {});
  ASSERT_EQ(again.types.size(), m.assets.types.size());
  for (std::size_t i = 0; i < again.types.size(); ++i)
    EXPECT_EQ(again.contents[i].sha256, m.assets.contents[i].sha256) << again.types[i].name;
  provenance.assets[0].sha256[0] ^= 1;
  EXPECT_THROW(load_assets(provenance, {}), InputError);
}

}  // namespace collapse_test
}  // namespace rubble::testing
