// From piles to scenes for simulators: masses and joints are those of the kernel's world.
#include "app/simulators/build_sim_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "app/scene/build_scene.h"
#include "io/scenes/pile_export.h"
#include "kernel/base/error.h"
#include "kernel/world/world.h"
#include "scripting/mission.h"
#include "scripting/robots/crawler.h"
#include "scripting/robots/rover.h"
#include "scripting/robots/vine.h"

namespace rubble::testing {
namespace sim_scene_build_test {

struct Placed {
  ResolvedMission mission;
  PileState state;
  std::unique_ptr<World> world;

  // text: of the table of the mission.
  explicit Placed(const std::string& text) {
    const Mission loaded = load_mission_text("return rubble.mission {" + text + "}", "m.lua");
    mission.scenario = loaded.scenario;
    mission.assets = load_assets(loaded, {});
    const Pile pile = make_pile(mission);
    world = std::make_unique<World>(pile.types, WorldOptions{}, pile.assemblies);
    std::vector<NewPiece> pieces;
    for (const Placement& p : pile.placed) pieces.emplace_back().placement = p;
    world->add(pieces);
    for (int i = 0; i < world->size(); ++i) state.pieces.push_back(world->piece(i));
    state.joints = world->joints();
  }

  BuiltScene build(const std::string& dynamic, const std::vector<MissionRobot>& robots = {}) const {
    return build_sim_scene(mission, state, robots, parse_dynamic(dynamic, "--dynamic"), 1);
  }
};

const char* const kArticulated[] = {"hinged_slab", "slab_hanging_bars", "rebar_bundle", "facade_panels", "door_on_frame", "car_with_door"};

// Bundled assets with joints, once free and once with a root that is held.
Placed place_articulated() {
  std::string placed;
  int count = 0;
  for (const std::string name : kArticulated)
    for (const char* fixed : {"false", "true"})
      placed += "{ asset = '" + name + "', fixed = " + fixed + ", position = { " + std::to_string(10 * count++) +
                ", 0, 3 }, rpy_deg = { 20, 30, 40 }, scale = 1.25 },";
  return Placed("packs = { 'concrete', 'bridge', 'parking', 'residential' }, pile = { layers = 0, placed = { " + placed + " } }");
}

double free_mass(const SimScene& scene) {
  double mass = 0;
  for (const SimModel& model : scene.models)
    for (std::size_t i = 0; i < model.links.size(); ++i)
      if (!model.robot && (!model.fixed || i > 0)) mass += model.links[i].mass;
  return mass;
}

TEST(SimSceneBuild, JointsHoldTheirLinksWhereTheKernelHasThem) {
  const Placed placed = place_articulated();
  const SimScene scene = placed.build("all").model.sim;
  double mass = 0;
  for (int i = 0; i < placed.world->size(); ++i) mass += placed.world->mass(i);
  EXPECT_NEAR(free_mass(scene), mass, 1e-9 * mass);
  std::size_t joints = 0;
  for (const SimModel& model : scene.models) {
    for (const SimJoint& joint : model.joints) {
      ++joints;
      const SimLink &parent = model.links[std::size_t(joint.parent)], &child = model.links[std::size_t(joint.child)];
      const Pose a = parent.world_from_link * joint.parent_from_joint, b = child.world_from_link * joint.child_from_joint;
      EXPECT_LT(distance(a.translation, b.translation), 1e-9) << child.name;
      EXPECT_NEAR(joint.position, 0, 1e-9) << "as designed";
      EXPECT_TRUE(joint.loop || joint.parent < joint.child);
      const Vec3 centre = placed.world->centre_of_mass(child.number);
      EXPECT_LT(distance(centre, child.centre_of_mass), 1e-9) << child.name;
    }
  }
  EXPECT_EQ(joints, placed.state.joints.size());
  EXPECT_GT(joints, 12u);
  for (const MeshFormat& format : mesh_formats())
    if (format.limits) format.limits(scene);
}

TEST(SimSceneBuild, SpringsGrowWithTheScaleAsInTheKernel) {
  const Placed placed = place_articulated();
  const SimScene scene = placed.build("all").model.sim;
  const double s = 1.25, slides = s * s, turns = s * s * s * s;
  std::size_t compared = 0;
  for (const SimModel& model : scene.models)
    for (const SimJoint& joint : model.joints) {
      if (joint.loop || joint.kind == JointKind::weld) continue;
      const SimLink& child = model.links[std::size_t(joint.child)];
      const int child_type = placed.state.pieces[std::size_t(child.number)].type;
      bool fits = false;
      for (const AssemblyType& assembly : placed.mission.assets.assemblies)
        for (const JointType& type : assembly.joints)
          fits = fits || (type.kind == joint.kind && assembly.links[std::size_t(type.child)].type == child_type &&
                          std::abs(joint.damping - type.damping * (joint.kind == JointKind::slider ? slides : turns)) <= 1e-9 * joint.damping);
      EXPECT_TRUE(fits) << child.name << ": " << joint.damping;
      ++compared;
    }
  EXPECT_GT(compared, 8u);
}

// Pieces of a building that still hold together are one body with their common mass.
TEST(SimSceneBuild, AGroupOfABuildingIsOneBody) {
  Placed placed("pile = { layers = 0, placed = { { box = { 1, 1, 1 }, material = 'brick', fixed = false, position = { 0, 0, 0.5 } }, "
                "{ box = { 1, 1, 1 }, material = 'brick', fixed = false, position = { 2, 0, 0.5 } }, "
                "{ box = { 1, 1, 1 }, material = 'brick', fixed = false, position = { 9, 0, 0.5 } } } }");
  placed.state.building.first = 0, placed.state.building.count = 3;
  placed.state.building.bodies = {{0, 1}};
  TieState tie;
  tie.piece_a = 1, tie.piece_b = 2;
  placed.state.building.ties = {tie};
  const BuiltScene built = placed.build("all");
  ASSERT_EQ(built.model.sim.models.size(), 2u);
  const SimLink& pair = built.model.sim.models[0].links[0];
  EXPECT_EQ(pair.parts.size(), 2u);
  EXPECT_NEAR(pair.mass, placed.world->mass(0) + placed.world->mass(1), 1e-9);
  EXPECT_LT(distance(pair.world_from_link * pair.centre_of_mass, {1, 0, 0.5}), 1e-9);
  const double one = placed.world->mass(0);
  EXPECT_NEAR(pair.inertia.rows[2].z, 2 * (one / 6 + one), 1e-6) << "two cubes, 1 m beside the common centre";
  bool said = false;
  for (const std::string& note : built.notes) said = said || note.find("1 tie of reinforcing bars is left out") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(SimSceneBuild, OnlyWhatIsNearIsFree) {
  const Placed placed("pile = { layers = 0, placed = { { box = { 1, 1, 1 }, material = 'brick', fixed = false, position = { 0, 0, 0.5 } }, "
                      "{ box = { 1, 1, 1 }, material = 'brick', fixed = false, position = { 0, 0, 5 } }, "
                      "{ box = { 1, 1, 1 }, material = 'brick', position = { 9, 0, 0.5 }, fixed = true } } }");
  const auto free = [&](const std::string& choice) {
    std::string which;
    for (const SimModel& model : placed.build(choice).model.sim.models) which += model.fixed ? '-' : '+';
    return which;
  };
  EXPECT_EQ(free("none"), "---");
  EXPECT_EQ(free("all"), "++-") << "what is fixed in Rubble stays";
  EXPECT_EQ(free("near=0,0,2"), "++-") << "at any height";
  EXPECT_EQ(free("near=0,0,0,2"), "+--");
  EXPECT_EQ(free("near=9,0,0.5,2"), "---");
  EXPECT_THROW(parse_dynamic("near=1,2", "--dynamic"), InputError);
}

TEST(SimSceneBuild, RobotsStandWhereTheMissionPutsThem) {
  const Placed placed("pile = { layers = 0 }, robots = { { name = 'rover', model = 'rover', position = { 3, 0, 0.001 }, rpy_deg = { 0, 0, 90 } }, "
                      "{ model = 'crawler', position = { 0, 0, 0.001 } }, { model = 'vine', position = { -3, 0, 0.001 } } }, "
                      "cameras = { front = { ride = { robot = 'rover' }, position = { 0.2, 0, 0.3 } } }");
  std::vector<MissionRobot> robots(3);
  robots[0].model = make_rover({}), robots[1].model = make_crawler({}), robots[2].model = make_vine({});
  const BuiltScene built = placed.build("none", robots);
  ASSERT_EQ(built.model.sim.models.size(), 2u) << "the vine has no counterpart";
  const SimModel& rover = built.model.sim.models[0];
  EXPECT_FALSE(rover.fixed);
  EXPECT_NEAR(rover.links[0].world_from_link.translation.x, 3, 1e-12);
  std::map<SimDrive, int> drives;
  for (const SimModel& model : built.model.sim.models)
    for (const SimJoint& joint : model.joints) ++drives[joint.drive];
  EXPECT_EQ(drives[SimDrive::velocity], 4) << "wheels";
  EXPECT_EQ(drives[SimDrive::position], 4) << "flippers";
  ASSERT_EQ(built.model.sim.cameras.size(), 1u);
  EXPECT_EQ(built.model.sim.cameras[0].model, 0);
  std::string notes;
  for (const std::string& note : built.notes) notes += note + "\n";
  EXPECT_NE(notes.find("the belts of 6 links stand still"), std::string::npos) << notes;
  EXPECT_NE(notes.find("is left out: no simulator has a tube"), std::string::npos) << notes;
}

TEST(SimSceneBuild, TerrainAndStreetAreSurfaces) {
  const Placed placed("pile = { layers = 0, terrain = { columns = 3, rows = 3, heights = { 0, 0, 0, 0, 1, 0, 0, 0, 0 } }, "
                      "placed = { { box = { 1, 1, 1 }, material = 'brick', position = { 0, 0, 5 } } } }");
  const SimScene scene = placed.build("all").model.sim;
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_FALSE(scene.surfaces[0].mesh->triangles.empty());
  for (const SimModel& model : scene.models)
    EXPECT_EQ(model.links[0].parts[0].shape < 0, model.links[0].label == "terrain") << "it is seen, and felt by its surface";
}

}  // namespace sim_scene_build_test
}  // namespace rubble::testing
