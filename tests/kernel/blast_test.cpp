// Blasts against closed forms: the impulse on a face, the energy that bonds take, shadows.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/settling/building_collapse.h"
#include "kernel/settling/collapse.h"
#include "kernel/structure/building.h"
#include "kernel/world/world_structures.h"
#include "tests/kernel/member_scenes.h"

namespace rubble {
namespace blast_test {

// A wall of one piece, 2 m wide, 1 m high and 0.2 m thick, across X at x; its lower edge in the ground.
Member make_wall(const char* name, double x) {
  Member m = make_mast(1, 1, 1);
  m.name = name;
  m.kind = MemberKind::wall;
  m.size = {0.2, 2, 1};
  m.centre = {x, 0, 0.5};
  return m;
}

struct Blasted {
  bool stands;
  double speed;  // of the first piece, along X; unit: m/s
};

// One step after a blast at (-far, 0, 0.5) of that impulse per area where the wall at 0 begins.
Blasted blast_walls(const Structure& s, double impulse_there, double far) {
  World world(s.types);
  Collapse collapse(world, s, 0, {});
  const double r = far - 0.1;
  collapse.blast({-far, 0, 0.5}, impulse_there * r * r);
  collapse.begin_step();
  world.step();
  collapse.end_step();
  return {world.piece(0).status == PieceStatus::fixed, world.structures().centre_velocity(0).x};
}

TEST(Blast, TakesOffAWallWhoseMotionIsMoreEnergyThanItsFootTakes) {
  const Structure s = build_structure({make_wall("wall", 0)}, 1);
  ASSERT_EQ(s.pieces.size(), 1u);
  double energy = 0;
  for (const Bond& bond : s.bonds) energy += calc_breaking_energy(bond.section);
  const double mass = s.pieces[0].mass, area = 2;
  const double least = std::sqrt(2 * mass * energy) / area;  // unit: N s/m2
  EXPECT_TRUE(blast_walls(s, 0.98 * least, 40).stands);
  EXPECT_FALSE(blast_walls(s, 1.02 * least, 40).stands);
  // Three times that impulse: nine times the energy, of which one is taken. Gravity acts downwards only.
  const Blasted thrown = blast_walls(s, 3 * least, 40);
  EXPECT_FALSE(thrown.stands);
  EXPECT_NEAR(thrown.speed, std::sqrt(8.0 / 9) * 3 * least * area / mass, 0.01 * thrown.speed);
}

TEST(Blast, DecreasesWithTheSquareOfTheDistanceAndTheCosineOfIncidence) {
  const Structure s = build_structure({make_wall("wall", 0)}, 1);
  const auto speed = [&](const Vec3& at, double impulse) {
    World world(s.types);
    Collapse collapse(world, s, 0, {});
    collapse.blast(at, impulse);
    collapse.begin_step();
    world.step();
    collapse.end_step();
    return world.structures().centre_velocity(0).x;
  };
  const double near = speed({-10.1, 0, 0.5}, 1e7), far = speed({-20.1, 0, 0.5}, 1e7);
  EXPECT_NEAR(near / far, 4, 0.02);
  // At 60 degrees off: half of it on the front; the side face is pushed along Y.
  const double oblique = speed({-0.1 - 10 * 0.5, 10 * std::sqrt(0.75), 0.5}, 1e7);
  EXPECT_NEAR(oblique / near, 0.5, 0.01);
  EXPECT_LT(speed({10, 0, 0.5}, 1e7), 0) << "away from a charge behind it";
}

TEST(Blast, DoesNotReachWhatStandsInTheShadow) {
  Member front = make_wall("front", -1);
  front.size = {0.2, 4, 2}, front.centre = {-1, 0, 1};
  const Structure alone = build_structure({make_wall("wall", 0)}, 1);
  const Structure both = build_structure({make_wall("wall", 0), front}, 1);
  EXPECT_FALSE(blast_walls(alone, 2000, 40).stands);
  EXPECT_TRUE(blast_walls(both, 2000, 40).stands);
}

// A charge before a street front takes walls, not the frame: until now the building as a whole was sheared off
// its columns' feet.
TEST(Blast, LeavesTheFrameOnItsFeet) {
  BuildingSpec b;
  b.storeys = 3, b.bays_x = b.bays_y = 2;
  b.column = 0.3, b.piece = 1.3, b.seed = 8;
  b.cause.blast = 4000, b.cause.blast_at = {0, -6.5, 1};
  Pile pile;
  pile.building = b;
  pile.types = make_building_types(b);
  World world(pile.types, calc_world_options({}));
  BuildingCollapse collapse(world, pile, {});
  for (int i = 0; i < 60; ++i) {
    collapse.before_step();
    world.step();
    collapse.after_step();
  }
  const Structure s = build_structures(b).damaged;
  int thrown_walls = 0;
  for (std::size_t i = 0; i < s.pieces.size(); ++i) {
    const Member& member = s.members[std::size_t(s.pieces[i].member)];
    const bool stands = world.piece(int(i)).status == PieceStatus::fixed;
    const bool wall = member.kind == MemberKind::wall, back = s.pieces[i].centre.y > 0;
    if (wall && !stands) ++thrown_walls;
    if (member.kind == MemberKind::column || (wall && back)) {
      EXPECT_TRUE(stands) << member.name;
    }
  }
  EXPECT_GT(thrown_walls, 5);
}

}  // namespace blast_test
}  // namespace rubble
