// What stands on the floors of a building before it collapses.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "kernel/base/error.h"
#include "kernel/settling/building_collapse.h"
#include "kernel/settling/furnish.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "tests/kernel/scenes.h"

namespace rubble {
namespace furnish_test {

PileSpec make_spec(const std::vector<Furnishing>& furniture) {
  PileSpec spec;
  spec.seed = 3;
  spec.layers = 0;
  spec.building.storeys = 2;
  spec.building.bays_x = 3, spec.building.bays_y = 2;
  spec.building.seed = 3;
  spec.types = {testing::box_type("cupboard", 1.2, 0.5, 1.8), testing::box_type("table", 1.5, 0.8, 0.7)};
  spec.building_first_type = int(spec.types.size());
  for (const PieceType& type : make_building_types(spec.building)) spec.types.push_back(type);
  spec.furniture = furniture;
  return spec;
}

std::vector<Aabb> boxes_of(const Pile& pile) {
  std::vector<Aabb> boxes;
  for (const Placement& placement : pile.placed) {
    Aabb box;
    for (const ConvexPart& part : pile.types[placement.kind.index].parts) {
      for (const Vec3& point : part.points) box.include(placement.world_from_body * point);
    }
    boxes.push_back(box);
  }
  return boxes;
}

TEST(Furnish, StandsOnEveryFloorAndOnTheRoofIfAsked) {
  const PileSpec spec = make_spec({{0, 1, false}, {1, 2, true}});
  std::map<int, int> cupboards, tables;  // by floor
  const Pile pile = generate_pile(spec);
  for (const Placement& placement : pile.placed) {
    const Aabb box = boxes_of(pile)[std::size_t(&placement - pile.placed.data())];
    const int floor = int(std::lround(box.min.z / spec.building.storey_height));
    EXPECT_NEAR(box.min.z, floor * spec.building.storey_height, 0.003);
    ++(placement.kind == 0 ? cupboards : tables)[floor];
    EXPECT_FALSE(placement.fixed);
  }
  EXPECT_EQ(cupboards, (std::map<int, int>{{0, 6}, {1, 6}}));
  EXPECT_EQ(tables, (std::map<int, int>{{0, 12}, {1, 12}, {2, 12}}));
}

TEST(Furnish, NothingTouchesAnythingAndTheBuildingStands) {
  const PileSpec spec = make_spec({{0, 2.5, false}, {1, 2.5, true}});
  const Pile pile = generate_pile(spec);
  const std::vector<Aabb> boxes = boxes_of(pile);
  ASSERT_GT(boxes.size(), 40u);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool apart = boxes[i].min.x > boxes[k].max.x || boxes[k].min.x > boxes[i].max.x ||
                         boxes[i].min.y > boxes[k].max.y || boxes[k].min.y > boxes[i].max.y ||
                         boxes[i].min.z > boxes[k].max.z || boxes[k].min.z > boxes[i].max.z;
      EXPECT_TRUE(apart) << i << " and " << k;
    }
  }
  SettleOptions options;
  options.threads = 1;
  const PileState state = settle_pile(pile, options);
  EXPECT_TRUE(state.settled);
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    const PieceState& piece = state.pieces[i];
    if (piece.type < spec.building_first_type) continue;
    EXPECT_EQ(piece.status, PieceStatus::fixed) << i;
  }
  EXPECT_LT(state.deepest_overlap.depth, 0.002);
}

TEST(Furnish, DependsOnTheSeed) {
  PileSpec spec = make_spec({{0, 1, false}});
  const Pile first = generate_pile(spec);
  const Pile again = generate_pile(spec);
  spec.seed = 4;
  const Pile other = generate_pile(spec);
  const auto at = [](const Pile& pile) { return pile.placed[0].world_from_body.translation; };
  EXPECT_TRUE(at(first) == at(again));
  EXPECT_FALSE(at(first) == at(other));
}

TEST(Furnish, NamesWhatDoesNotFit) {
  for (const Vec3& size : {Vec3{1.2, 0.5, 2.7}, Vec3{5.2, 0.5, 1}, Vec3{4.8, 4.8, 1}}) {
    PileSpec spec = make_spec({{1, 1, false}, {0, 1, false}});
    spec.types[0] = testing::box_type("cupboard", size.x, size.y, size.z);
    try {
      generate_pile(spec);
      ADD_FAILURE() << "must not be accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("pile.building.furniture[2].asset"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace furnish_test
}  // namespace rubble
