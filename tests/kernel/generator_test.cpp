#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/geometry/shape.h"
#include "kernel/model/pile.h"
#include "kernel/settling/generator.h"
#include "kernel/world/world_diagnostics.h"
#include "scenes.h"

namespace rubble {
namespace generator_test {

TEST(Generator, NoTwoPiecesOfALayerTouch) {
  const PileSpec spec = testing::small_pile(3, 2, 120);
  const Pile pile = generate_pile(spec);
  ASSERT_EQ(pile.layers.size(), 2u);
  for (const Layer& layer : pile.layers) {
    ASSERT_EQ(layer.pieces.size(), 120u);
    // No contact in the first step of a world without gravity means no overlap and no near miss.
    WorldOptions options;
    options.gravity = 0;
    World world(pile.types, options);
    std::vector<NewPiece> pieces;
    for (const Placement& p : layer.pieces) {
      pieces.push_back({});
      pieces.back().placement = p;
      pieces.back().placement.world_from_body.translation.z += 1;
    }
    world.add(pieces);
    world.step();
    for (int i = 0; i < world.size(); ++i) EXPECT_FALSE(world.is_touching(i)) << i;
    EXPECT_EQ(world.diagnostics().kinetic_energy(), 0);
  }
}

TEST(Generator, PiecesStayAboveTheBottom) {
  const Pile pile = generate_pile(testing::small_pile(4));
  for (const Layer& layer : pile.layers) {
    for (const Placement& p : layer.pieces) {
      for (const ConvexPart& part : pile.types[p.kind.index].parts) {
        for (const Vec3& v : part.points) EXPECT_GE((p.world_from_body * (v * p.scale)).z, -1e-9);
      }
    }
  }
}

TEST(Generator, SeedDecides) {
  const auto first_x = [](std::uint64_t seed) {
    return generate_pile(testing::small_pile(seed)).layers[0].pieces[0].world_from_body.translation.x;
  };
  EXPECT_EQ(first_x(1), first_x(1));
  EXPECT_NE(first_x(1), first_x(2));
}

TEST(Generator, AFullLayerSaysHowManyFitted) {
  PileSpec spec = testing::small_pile(1, 1, 5000);
  spec.spawn_bounds = {2, 2, 2};
  try {
    generate_pile(spec);
    FAIL() << "no error";
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics()[0];
    EXPECT_EQ(d.key, "pieces_per_layer");
    EXPECT_NE(d.message.find("layer 1"), std::string::npos);
    EXPECT_NE(d.found.find("5000 pieces, of which "), std::string::npos) << d.found;
    EXPECT_NE(d.hint.find("spawn_bounds"), std::string::npos);
  }
}

// Shares of the pieces over the quarters of the box, against their weights.
TEST(Generator, ADensityIsDrawnInProportion) {
  PileSpec spec = testing::small_pile(1, 20, 100);
  spec.spawn_bounds = {8, 8, 8};
  spec.spawn_position = {3, -1, 5};
  spec.spawn_density = {2, 2, {0, 1, 3, 4}};  // row by row from the lowest y
  double count[4] = {}, all = 0;
  for (const Layer& layer : generate_pile(spec).layers) {
    for (const Placement& p : layer.pieces) {
      const Shape shape = compile_shape(spec.types[p.kind.index], "");
      const Vec3 centre = p.world_from_body * (shape.volume.centre_of_mass * p.scale);
      EXPECT_LT(std::abs(centre.x - 3), 4);
      EXPECT_LT(std::abs(centre.y + 1), 4);
      count[(centre.x > 3) + 2 * (centre.y > -1)] += 1;
      all += 1;
    }
  }
  EXPECT_EQ(count[0], 0);
  EXPECT_NEAR(count[1] / all, 1.0 / 8, 0.04);  // 5 standard deviations
  EXPECT_NEAR(count[2] / all, 3.0 / 8, 0.06);
  EXPECT_NEAR(count[3] / all, 4.0 / 8, 0.06);
}

TEST(Generator, AnEvenDensityIsEven) {
  PileSpec spec = testing::small_pile(1, 4, 100);
  spec.spawn_density = {3, 1, {1, 1, 1}};
  double left = 0;
  for (const Layer& layer : generate_pile(spec).layers)
    for (const Placement& p : layer.pieces)
      left += p.world_from_body.translation.x < spec.spawn_position.x;
  EXPECT_NEAR(left / 400, 0.5, 0.13);
}

TEST(Generator, ABadDensityIsRefused) {
  for (const SpawnDensity& density :
       {SpawnDensity{2, 2, {1, 2, 3}}, SpawnDensity{1, 2, {0, 0}}, SpawnDensity{1, 2, {1, -1}},
        SpawnDensity{0, 0, {1}}}) {
    PileSpec spec = testing::small_pile(1);
    spec.spawn_density = density;
    EXPECT_THROW(generate_pile(spec), InputError);
  }
}

TEST(Generator, AllMistakesAreNamedAtOnce) {
  PileSpec spec = testing::small_pile(1);
  spec.layers = -1;
  spec.spawn_bounds.y = 0;
  spec.mix[2].kind = 99;
  try {
    generate_pile(spec);
    FAIL() << "no error";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 3u);
    EXPECT_EQ(error.diagnostics()[0].key, "mix[2].type");
    EXPECT_EQ(error.diagnostics()[1].key, "layers");
    EXPECT_EQ(error.diagnostics()[2].key, "spawn_bounds.y");
  }
}

}  // namespace generator_test
}  // namespace rubble
