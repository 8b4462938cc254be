// Materials that a mix draws: as often as stated, with the figures of the material, and found again.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <vector>

#include "app/provenance/provenance.h"
#include "app/scene/build_scene.h"
#include "kernel/geometry/shape.h"
#include "kernel/settling/generator.h"
#include "render/geometry/geometry.h"
#include "scripting/mission.h"

namespace rubble::testing {
namespace mix_materials_test {

Mission load(const std::string& mix, int seed = 1) {
  return load_mission_text("return rubble.mission { seed = " + std::to_string(seed) +
                               ", pile = { layers = 4, pieces_per_layer = 1000, spawn_bounds = "
                               "{ 30, 30, 20 },\nmix = {\n" + mix + "} } }",
                           "m.lua");
}

const char* const kMix =
    "{ asset = 'half_brick', weight = 3 },\n"
    "{ asset = 'chunk_4', weight = 5, materials = { { material = 'brick', weight = 3 },\n"
    "  { material = 'reinforced_concrete', weight = 6 }, { material = 'timber' } } },\n";

std::map<std::string, int> count(const Mission& mission, const AssetLibrary& assets) {
  std::map<std::string, int> counts;
  for (const Layer& layer : generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets)).layers)
    for (const Placement& piece : layer.pieces)
      ++counts[assets.types[std::size_t(piece.kind.index)].name];
  return counts;
}

double chi_square(std::map<std::string, int> counts, const std::map<std::string, double>& shares) {
  double sum = 0;
  for (const auto& [name, share] : shares) {
    const double expected = 4000 * share, off = counts[name] - expected;
    sum += off * off / expected;
  }
  return sum;
}

TEST(MixMaterials, AreDrawnByTheirWeights) {
  const double limit = 16.27;  // three degrees of freedom, one in a thousand
  const std::map<std::string, double> stated = {{"half_brick", 0.375},
                                                {"chunk_4 of brick", 0.1875},
                                                {"chunk_4 of reinforced_concrete", 0.375},
                                                {"chunk_4 of timber", 0.0625}};
  const std::map<std::string, double> other = {{"half_brick", 0.375},
                                               {"chunk_4 of brick", 0.2175},
                                               {"chunk_4 of reinforced_concrete", 0.345},
                                               {"chunk_4 of timber", 0.0625}};
  for (const int seed : {1, 2, 3}) {
    const Mission mission = load(kMix, seed);
    const auto counts = count(mission, load_assets(mission, {}));
    EXPECT_EQ(counts.size(), 4u);
    EXPECT_LT(chi_square(counts, stated), limit) << "seed " << seed;
    EXPECT_GT(chi_square(counts, other), limit) << "seed " << seed;
  }
}

TEST(MixMaterials, GiveWeightFrictionAndLook) {
  const AssetLibrary assets = load_assets(load(kMix), {});
  const auto type = [&](const char* name) -> const PieceType& {
    return assets.types[std::size_t(assets.find(name).index)];
  };
  EXPECT_EQ(type("chunk_4 of brick").density, 1900);
  EXPECT_EQ(type("chunk_4 of brick").friction, 0.65);
  EXPECT_EQ(type("chunk_4 of timber").density, 500);
  EXPECT_EQ(type("chunk_4 of reinforced_concrete").density, type("chunk_4").density);
  EXPECT_EQ(type("chunk_4 of timber").parts.size(), type("chunk_4").parts.size());
  const auto looks = [&](const char* name) {
    std::string all;
    for (const std::string& look :
         assets.meshes[std::size_t(assets.find(name).index)]->levels.front().surface_names)
      all += look + " ";
    return all;
  };
  EXPECT_NE(looks("chunk_4 of brick").find("brick_fracture"), std::string::npos);
  EXPECT_EQ(looks("chunk_4 of brick").find("concrete"), std::string::npos);
  EXPECT_NE(looks("chunk_4").find("concrete"), std::string::npos);
  // A mesh need not have every look that the other material changes.
  EXPECT_TRUE(assets.warnings.empty()) << assets.warnings.front();
}

TEST(MixMaterials, AreFoundAgainFromARecipe) {
  const Mission mission = load(kMix);
  const AssetLibrary assets = load_assets(mission, {});
  Provenance provenance = make_provenance(RunKind::settle, mission, {});
  provenance.assets = assets.contents;
  const AssetLibrary again = load_assets(provenance, {});
  ASSERT_EQ(again.types.size(), assets.types.size());
  for (std::size_t i = 0; i < again.types.size(); ++i) {
    EXPECT_EQ(again.types[i].name, assets.types[i].name);
    EXPECT_EQ(again.contents[i].sha256, assets.contents[i].sha256);
  }
  ASSERT_EQ(again.mix.size(), assets.mix.size());
  for (std::size_t i = 0; i < again.mix.size(); ++i) {
    EXPECT_EQ(again.mix[i].kind, assets.mix[i].kind);
    EXPECT_EQ(again.mix[i].weight, assets.mix[i].weight);
  }
}

TEST(MixMaterials, AreInTheResolvedScenario) {
  const std::string json = scenario_to_json(load(kMix).scenario);
  EXPECT_NE(json.find("\"material\": \"timber\""), std::string::npos) << json;
  EXPECT_EQ(scenario_to_json(scenario_from_json(json, "s.json")), json);
}

std::string error_of(const std::string& mix) {
  try {
    load_assets(load(mix), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MixMaterials, MistakesAreNamed) {
  EXPECT_NE(error_of("{ asset = 'chunk_4', materials = { { material = 'brik' } } }")
                .find("m.lua:3: pile.mix[1].materials[1].material: unknown material `brik`"),
            std::string::npos)
      << error_of("{ asset = 'chunk_4', materials = { { material = 'brik' } } }");
  EXPECT_NE(error_of("{ asset = 'chunk_4', materials = { { material = 'brik' } } }")
                .find("did you mean `brick`?"),
            std::string::npos);
  EXPECT_NE(error_of("{ asset = 'chunk_4', materials = { { material = 'brick', weight = 0 } } }")
                .find("all weights are 0"),
            std::string::npos);
  EXPECT_NE(error_of("{ asset = 'hinged_slab', materials = { { material = 'brick' } } }")
                .find("keeps its materials"),
            std::string::npos);
}

// Another mission that keeps a pile has a seed of its own, of its noise; pieces look as they did.
TEST(AdoptedPile, LooksAsInTheMissionThatSettledIt) {
  const Mission settled = load(kMix, 3), other = load(kMix, 7);
  Scenario kept = other.scenario;
  adopt_pile(kept, settled.scenario);
  const AssetLibrary assets = load_assets(settled, {});
  PileState pile;
  for (std::size_t i = 0; i < assets.types.size(); ++i) pile.types.push_back(assets.types[i].name);
  pile.pieces.resize(20);
  const auto looks_of = [&](const Scenario& scenario) {
    std::vector<std::array<std::uint32_t, 2>> looks;
    for (const PlacedMesh& piece : prepare_scene(build_scene(scenario, assets, pile), 1).placed) looks.push_back(piece.look_seed);
    return looks;
  };
  EXPECT_EQ(kept.seed, 7U);
  EXPECT_EQ(looks_of(kept), looks_of(settled.scenario));
  EXPECT_NE(looks_of(kept), looks_of(other.scenario));
}

}  // namespace mix_materials_test
}  // namespace rubble::testing
