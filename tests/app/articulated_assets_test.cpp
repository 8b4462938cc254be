// The bundled articulated assets, dropped: they come to rest, stay together within the limits of their
// joints, and do not creep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/scene/build_scene.h"
#include "kernel/settling/generator.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"
#include "scripting/mission.h"

namespace rubble::testing {
namespace articulated_assets_test {

struct Exhibit {
  const char* pack;
  const char* name;
};

// Two of it, dropped askew, and one that is held in the air by its first link.
struct Drop {
  AssetLibrary assets;
  std::vector<NewPiece> pieces;

  explicit Drop(const Exhibit& e) {
    const std::string item = std::string("{ asset = '") + e.name + "', fixed = false, position = ";
    const Mission mission = load_mission_text(
        std::string("return rubble.mission { packs = { '") + e.pack +
            "' }, pile = { layers = 0, placed = {\n" + item +
            "{ 0, 0, 2.2 }, rpy_deg = { 25, 15, 40 } },\n" + item +
            "{ 9, 0, 2.4 }, rpy_deg = { 160, -20, 0 } },\n{ asset = '" + e.name +
            "', fixed = true, position = { -9, 0, 4 }, rpy_deg = { -90, 0, 0 } } } } }",
        "m.lua");
    assets = load_assets(mission, {});
    for (const Placement& p :
         generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets)).placed) {
      pieces.push_back({});
      pieces.back().placement = p;
    }
  }
};

// How far a joint is bent from where it was designed; unit: rad. And how far its halves are apart;
// unit: m
struct Bend {
  double angle = 0, apart = 0;
};

Bend calc_bend(const World& world, const JointState& joint) {
  const Pose a = world.piece(joint.parent).world_from_body * joint.parent_from_joint;
  const Pose b = world.piece(joint.child).world_from_body * joint.child_from_joint;
  const Quat turn = a.rotation.conjugate() * b.rotation;
  double angle = joint.kind == JointKind::hinge
                     ? 2 * std::atan2(turn.z, turn.w)
                     : 2 * std::acos(std::min(1.0, std::abs(turn.w)));
  if (angle > 3.14159265) angle -= 2 * 3.14159265;
  if (angle < -3.14159265) angle += 2 * 3.14159265;
  return {angle, distance(a.translation, b.translation)};
}

class ArticulatedAsset : public ::testing::TestWithParam<Exhibit> {};

TEST_P(ArticulatedAsset, SettlesWithinItsLimitsAndDoesNotCreep) {
  const Drop drop(GetParam());
  World world(drop.assets.types, {}, drop.assets.assemblies);
  world.add(drop.pieces);
  const AssemblyType& design = drop.assets.assemblies.at(0);
  const int links = int(design.links.size());
  ASSERT_EQ(world.size(), 3 * links);
  const std::size_t joints = world.joints().size();
  ASSERT_EQ(joints, 3 * design.joints.size());

  double most_bent = 0;
  const auto check_joints = [&] {
    for (const JointState& joint : world.joints()) {
      const auto type = std::find_if(
          design.joints.begin(), design.joints.end(),
          [&](const JointType& j) { return j.child == joint.child % links; });
      ASSERT_NE(type, design.joints.end());
      const Bend bend = calc_bend(world, joint);
      EXPECT_LT(bend.apart, 1e-3);
      EXPECT_LT(bend.angle, type->upper + 0.06);
      EXPECT_GT(bend.angle, type->lower - 0.06);
      most_bent = std::max(most_bent, std::abs(bend.angle));
    }
  };
  const auto still = [&] { return world.rest().reached(0.05, 0.2) && world.diagnostics().all_have_touched(); };
  bool rests = false;
  while (world.time() < 25 && !rests) {
    for (int i = 0; i < 10; ++i) world.step();
    check_joints();
    if (!still()) continue;
    world.rest().begin_verification();
    for (int i = 0; i < 75 && !rests; ++i) {
      world.step();
      rests = world.rest().verified(0.05, 0.2);
    }
  }
  EXPECT_TRUE(rests) << "after " << world.time() << " s";
  EXPECT_GE(world.joints().size(), design.joints.size()) << "what hangs is still held";
  EXPECT_GT(most_bent, 0.03) << "nothing moved in its joints: the limits were not tried";

  // Kept awake it stays where it is.
  std::vector<Vec3> before;
  for (int i = 0; i < world.size(); ++i) before.push_back(world.piece(i).world_from_body.translation);
  world.set_sleeping(false);
  const double end = world.time() + 4;
  while (world.time() < end) world.step();
  for (int i = 0; i < world.size(); ++i)
    EXPECT_LT(distance(world.piece(i).world_from_body.translation, before[std::size_t(i)]), 0.01)
        << drop.assets.types[std::size_t(world.piece(i).type)].name;
}

INSTANTIATE_TEST_SUITE_P(Bundled, ArticulatedAsset,
                         ::testing::Values(Exhibit{"concrete", "hinged_slab"},
                                           Exhibit{"concrete", "slab_hanging_bars"},
                                           Exhibit{"concrete", "rebar_bundle"},
                                           Exhibit{"concrete", "facade_panels"},
                                           Exhibit{"residential", "door_on_frame"},
                                           Exhibit{"parking", "car_with_door"}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace articulated_assets_test
}  // namespace rubble::testing
