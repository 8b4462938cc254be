// Robots in a pile that has settled.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/robot/robot_run.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace robot_run_test {

struct Settled {
  Pile pile;
  PileState state;
};

// Two layers of chunks, bars, bricks and jointed debris, settled once for all tests.
const Settled& settled_pile() {
  static const Settled settled = [] {
    PileSpec spec = testing::small_pile(5, 2, 50);
    spec.assemblies = testing::assemblies();
    for (std::size_t i = 0; i < spec.assemblies.size(); ++i) {
      spec.mix.push_back({PieceKind::assembly(int(i)), 0.3, 1, 1});
    }
    spec.spawn_bounds = {3, 3, 3};
    Settled s;
    s.pile = generate_pile(spec);
    s.state = settle_pile(s.pile);
    return s;
  }();
  return settled;
}

// A heap of bricks that a crawler of 38 kg can push.
const Settled& brick_heap() {
  static const Settled settled = [] {
    PileSpec spec;
    spec.seed = 3;
    spec.types = {testing::box_type("brick", 0.22, 0.105, 0.065)};
    spec.mix = {{0, 1, 0.8, 1.2}};
    spec.spawn_bounds = {0.9, 0.9, 0.7};
    spec.layers = 2;
    spec.pieces_per_layer = 40;
    Settled s;
    s.pile = generate_pile(spec);
    s.state = settle_pile(s.pile);
    return s;
  }();
  return settled;
}

RobotRunOptions run_options(double duration, int threads = 1) {
  RobotRunOptions options;
  options.duration = duration;
  options.threads = threads;
  return options;
}

RobotController undulate(const RobotModel& model) {
  return [&model](const RobotSense& sense) {
    return calc_gait(model, sidewinding(), sense.time);
  };
}

RobotController push(const RobotModel& model, double speed) {
  return [&model, speed](const RobotSense&) { return drive_sides(model, speed, 0); };
}

TEST(RobotRun, APileThatIsLaidStaysAsItWas) {
  const Settled& s = settled_pile();
  ASSERT_TRUE(s.state.settled);
  ASSERT_FALSE(s.state.joints.empty());
  World world(s.pile.types, {}, s.pile.assemblies);
  world.lay(s.pile, s.state);
  EXPECT_EQ(world.awake_count(), 0);
  EXPECT_EQ(world.joints().size(), s.state.joints.size());
  world.set_step(1.0 / 240, 4);
  for (int i = 0; i < 240; ++i) world.step();
  EXPECT_EQ(world.awake_count(), 0);
  for (int i = 0; i < world.size(); ++i) {
    const Pose &was = s.state.pieces[std::size_t(i)].world_from_body, is = world.piece(i).world_from_body;
    EXPECT_NEAR(distance(was.translation, is.translation), 0, 1e-9) << i;
  }
  // Awake they stay too, as they rested: nothing jumps.
  world.wake_all();
  for (int i = 0; i < 120; ++i) world.step();
  int moved = 0;
  for (int i = 0; i < world.size(); ++i) {
    const Pose &was = s.state.pieces[std::size_t(i)].world_from_body, is = world.piece(i).world_from_body;
    moved += distance(was.translation, is.translation) > 0.005;
  }
  EXPECT_EQ(moved, 0);
}

TEST(RobotRun, ACrawlerPushesAPileAside) {
  const Settled& s = brick_heap();
  ASSERT_TRUE(s.state.settled);
  const RobotModel model = make_crawler();
  RobotRun run(s.pile, s.state, run_options(4));
  run.add(model, {{}, {-1.6, 0.2, 0.002}}, push(model, 0.4));
  const RobotRunResult result = run.run();
  EXPECT_GE(result.pieces_moved, 3);
  EXPECT_GT(result.robots[0].distance, 0.5);
  EXPECT_FALSE(result.robots[0].lost);
  EXPECT_EQ(result.first_piece[0], int(s.state.pieces.size()));
  EXPECT_EQ(result.track.find_fault(), "");
  // What did not move has one key.
  std::size_t single = 0;
  for (const TrackBody& body : result.track.bodies) single += body.keys.size() == 1;
  EXPECT_GT(single, 3u);
}

TEST(RobotRun, FixedDebrisNeverMoves) {
  const Settled& s = brick_heap();
  const RobotModel model = make_crawler();
  RobotRunOptions options = run_options(4);
  options.fixed_debris = true;
  RobotRun run(s.pile, s.state, options);
  run.add(model, {{}, {-1.6, 0.2, 0.002}}, push(model, 0.4));
  const RobotRunResult result = run.run();
  EXPECT_EQ(result.pieces_moved, 0);
  for (const TrackBody& body : result.track.bodies) {
    if (body.id >= int(s.state.pieces.size())) continue;
    EXPECT_EQ(body.keys.size(), 1u) << body.id;
  }
}

TEST(RobotRun, TheBitsDoNotDependOnThreads) {
  const Settled& s = brick_heap();
  const RobotModel snake = make_snake(), crawler = make_crawler(), rover = make_rover();
  std::uint64_t hashes[3] = {};
  const int threads[3] = {1, 2, 4};
  for (int k = 0; k < 3; ++k) {
    RobotRun run(s.pile, s.state, run_options(3, threads[k]));
    run.add(crawler, {{}, {-1.8, 0, 0.002}}, push(crawler, 0.4));
    run.add(snake, {{}, {0, 0, 0.6}}, undulate(snake));
    run.add(rover, {{}, {0, 1.9, 0.002}}, [&rover](const RobotSense&) {
      return drive_sides(rover, -0.5, 0.3);
    });
    hashes[k] = run.run().hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
  // The hash sees a push.
  RobotRun run(s.pile, s.state, run_options(3, 1));
  run.add(crawler, {{}, {-1.8, 1e-9, 0.002}}, push(crawler, 0.4));
  run.add(snake, {{}, {0, 0, 0.6}}, undulate(snake));
  run.add(rover, {{}, {0, 1.9, 0.002}}, [&rover](const RobotSense&) {
    return drive_sides(rover, -0.5, 0.3);
  });
  EXPECT_NE(run.run().hash(), hashes[0]);
}

// Another robot stood elsewhere and pushed the pile meanwhile.
TEST(RobotRun, ARestartHasTheBitsOfANewRun) {
  const Settled& s = brick_heap();
  const RobotModel crawler = make_crawler(), rover = make_rover();
  RobotRunOptions options = run_options(1.2, 1);
  options.restarts = true;
  RobotRun run(s.pile, s.state, options);
  std::uint64_t hashes[4] = {};
  for (int k = 0; k < 3; ++k) {
    if (k > 0) run.restart();
    if (k == 1) run.add(rover, {{}, {-1.7, 0.4, 0.002}}, [&](const RobotSense&) { return drive_sides(rover, 0.6, 0.1); });
    run.add(crawler, {{}, {k == 1 ? 2.5 : -1.6, 0.2, 0.002}}, push(crawler, 0.4));
    hashes[k] = run.run().hash();
  }
  RobotRun fresh(s.pile, s.state, run_options(1.2, 1));
  fresh.add(crawler, {{}, {-1.6, 0.2, 0.002}}, push(crawler, 0.4));
  hashes[3] = fresh.run().hash();
  EXPECT_EQ(hashes[0], hashes[3]);
  EXPECT_EQ(hashes[2], hashes[3]);
  EXPECT_NE(hashes[1], hashes[3]);
  EXPECT_THROW(fresh.restart(), RunError);
}

TEST(RobotRun, ARobotInsideAPieceIsNamed) {
  Pile pile;
  pile.types = {testing::box_type("slab", 2, 2, 0.2)};
  pile.placed.push_back({0, 1, {{}, {0, 0, 0.6}}, true});
  const PileState state = settle_pile(pile);
  const RobotModel model = make_rover();
  RobotRun run(pile, state, run_options(1));
  run.add(model, {{}, {0, 0, 0.62}}, [&](const RobotSense&) { return drive_sides(model, 0, 0); });
  try {
    run.run();
    FAIL();
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics()[0];
    EXPECT_EQ(d.key, "robots[1].position");
    EXPECT_NE(d.message.find("slab (piece 0)"), std::string::npos) << d.text();
    EXPECT_NE(d.message.find("0.08"), std::string::npos) << d.text();
    EXPECT_NE(d.hint.find("0.08"), std::string::npos) << d.text();
  }
}

// It would be lost in the first step, before anything could touch it.
TEST(RobotRun, ARobotOutsideOfTheWorldIsNamed) {
  const RobotModel model = make_rover();
  const struct {
    Vec3 at;
    std::string said;
  } cases[] = {{{0, 0, -0.7}, "settle.lost_below"}, {{0, 0, -20}, "settle.lost_below"}, {{150, 0, 0}, "settle.lost_beyond"}};
  for (const auto& c : cases) {
    RobotRun run({}, settle_pile({}), run_options(1));
    run.add(model, {{}, c.at}, [&](const RobotSense&) { return drive_sides(model, 0, 0); });
    try {
      run.run();
      FAIL() << c.at.x << " " << c.at.z;
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics()[0].key, "robots[1].position");
      EXPECT_NE(error.diagnostics()[0].message.find(c.said), std::string::npos) << error.what();
    }
  }
}

// A world with robots in mid-motion goes on from its snapshot with the same bits.
TEST(RobotRun, ASnapshotGoesOnWithTheSameBits) {
  const RobotModel model = make_snake();
  const auto advance = [&model](World& world, int from, int to) {
    for (int i = from; i < to; ++i) {
      if (i % 4 == 0) world.robots().set_command(0, calc_gait(model, sidewinding(), i / 240.0));
      world.step();
    }
  };
  World world = testing::make_robot_world();
  world.robots().add(model, {{}, {0, 0, 0.03}});
  advance(world, 0, 200);
  const auto snapshot = world.snapshot();
  advance(world, 200, 400);
  World other = testing::make_robot_world();
  other.robots().add(model, {{}, {0, 0, 0.03}});
  other.restore(*snapshot);
  advance(other, 200, 400);
  EXPECT_EQ(testing::hash_of(world), testing::hash_of(other));
}

}  // namespace robot_run_test
}  // namespace rubble
