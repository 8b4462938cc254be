// A world that is inspected: pulled by springs, saved as missions, with what its cameras see and its voids.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "app/drive/inspect/inspected_pile.h"
#include "app/drive/inspect/inspector.h"
#include "app/drive/inspect/mouse_spring.h"
#include "app/drive/inspect/snapshot.h"
#include "app/drive/overlay/sensor_frusta.h"
#include "app/drive/overlay/void_survey.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace inspect_test {

constexpr double kMass = 0.4 * 0.4 * 0.4 * 2400;

PieceType cube() {
  PieceType type;
  type.name = "cube";
  type.density = 2400, type.friction = 0.5;
  type.parts = {make_box({0.4, 0.4, 0.4}, {})};
  return type;
}

PieceType slab() {
  PieceType type = cube();
  type.name = "slab";
  type.parts = {make_box({20, 4, 0.2}, {})};
  return type;
}

World make_cube_world(double gravity, double step, const Vec3& position) {
  WorldOptions options;
  options.gravity = gravity, options.step = step, options.threads = 1;
  World world({cube(), slab()}, options);
  NewPiece piece;
  piece.placement.world_from_body.translation = position;
  world.add({piece});
  return world;
}

// With critical damping x = x0 (1 + w t) exp(-w t).
TEST(MouseSpring, BringsAPieceToTheMouseAsACriticallyDampedSpring) {
  const double step = 1e-3, omega = 2 * portable::kPi;
  World world = make_cube_world(0, step, {0, 0, 5});
  MouseSpring spring({1, 1, 1000});
  ASSERT_TRUE(spring.grab(world, 0, {0, 0, 5}));
  spring.pull_to({0.5, 0, 5});
  for (int i = 1; i <= 1000; ++i) {
    world.apply_impulse(0, spring.point(world), spring.calc_impulse(world, step));
    world.step();
    const double t = i * step, expected = 0.5 - 0.5 * (1 + omega * t) * std::exp(-omega * t);
    ASSERT_NEAR(world.piece(0).world_from_body.translation.x, expected, 4e-3) << t << " s";
  }
  EXPECT_GT(world.piece(0).world_from_body.translation.x, 0.49);
}

// How far a cube comes that is pulled from afar, at its centre, with as much as the spring can.
double slide(bool on_floor, double seconds) {
  const double step = 1.0 / 240;
  World world = make_cube_world(on_floor ? 9.81 : 0, step, {0, 0, on_floor ? 1.2005 : 5});
  if (on_floor) {
    NewPiece floor;
    floor.placement.kind = 1, floor.placement.fixed = true;
    floor.placement.world_from_body.translation.z = 0.9;
    world.add({floor});
    for (int i = 0; i < 240; ++i) world.step();
  }
  MouseSpring spring({4, 1, 2});  // at most twice the weight
  const Vec3 centre = world.piece(0).world_from_body.translation;
  EXPECT_TRUE(spring.grab(world, 0, centre));
  for (int i = 0; i < int(seconds / step + 0.5); ++i) {
    const Vec3 at = spring.point(world);
    spring.pull_to({at.x + 100, at.y, at.z});
    const Vec3 impulse = spring.calc_impulse(world, step);
    EXPECT_NEAR(norm(impulse) / step, 2 * 9.81 * kMass, 1e-6 * kMass);
    world.apply_impulse(0, at, impulse);
    world.step();
  }
  return world.piece(0).world_from_body.translation.x - centre.x;
}

// x = (F / m - mu g) t2 / 2
TEST(MouseSpring, PullsWithNoMoreThanItsForce) {
  const double t = 0.5, free = 0.5 * 2 * 9.81 * t * t, dragged = 0.5 * (2 - 0.5) * 9.81 * t * t;
  EXPECT_NEAR(slide(false, t), free, 0.02 * free);
  EXPECT_NEAR(slide(true, t), dragged, 0.04 * dragged);
}

TEST(MouseSpring, HoldsNothingThatIsFixedOrNotThere) {
  WorldOptions options;
  options.threads = 1;
  World world({cube()}, options);
  NewPiece piece;
  piece.placement.fixed = true;
  piece.placement.world_from_body.translation.z = 1;
  world.add({piece});
  MouseSpring spring;
  EXPECT_FALSE(spring.grab(world, 0, {0, 0, 1}));
  EXPECT_FALSE(spring.grab(world, 1, {0, 0, 1}));
  EXPECT_FALSE(spring.grab(world, -1, {0, 0, 1}));
  EXPECT_FALSE(spring.holds());
}

// The border of an image is where its corner pixels end.
TEST(SensorFrusta, CornersProjectToTheCornersOfTheImage) {
  PlacedCamera camera;
  camera.intrinsics.width = 100, camera.intrinsics.height = 80;
  camera.intrinsics.fx = camera.intrinsics.fy = 50, camera.intrinsics.cx = 49.5, camera.intrinsics.cy = 39.5;
  camera.world_from_camera.translation = {1, 2, 3};  // looks along X
  std::vector<OverlayLine> lines;
  add_frustum(camera, 2, lines);
  ASSERT_EQ(lines.size(), 4u * (1 + 12) + 1);
  // Upper left pixel corner (-0.5, -0.5): 1 along X, 1 to the left, 0.8 up.
  const Vec3 ray = Vec3{1, 1, 0.8} * 2.0;
  EXPECT_NEAR(distance(lines[0].to, Vec3{1, 2, 3} + ray), 0, 1e-9);
  EXPECT_NEAR(distance(lines[0].from, Vec3{1, 2, 3}), 0, 1e-12);
  EXPECT_GT(lines.back().to.z, lines.back().from.z) << "the tick points up";
}

TEST(SensorFrusta, ThoseOnRobotsThatAreNotThereAreLeftOut) {
  Scenario scenario;
  scenario.cameras.resize(2);
  scenario.cameras[0].name = "left", scenario.cameras[0].position = {0, 0.1, 0};
  scenario.cameras[1].name = "arm", scenario.cameras[1].ride.robot = "tank";
  const auto placed = place_cameras(scenario.cameras, [](const MountedCamera& camera) -> std::optional<Pose> {
    if (camera.ride.on()) return std::nullopt;
    return Pose{{}, {5, 0, 1}};
  });
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_EQ(placed[0].name, "left");
  EXPECT_NEAR(distance(placed[0].world_from_camera.translation, {5, 0.1, 1}), 0, 1e-12);
}

const char* const kBricks = R"(return rubble.mission {
  seed = 5,
  pile = { layers = 2, pieces_per_layer = 6, spawn_bounds = { 0.8, 0.8, 0.6 }, mix = { { asset = "brick" } } },
  camera = { width = 32, height = 24 }, trajectory = { rate_hz = 1, duration = 1 },
  outputs = { bag = false, rawlog = false, simplemap = false, stl = false, preview = false },
})";

struct Inspected {
  explicit Inspected(const ScratchFolder& scratch, const std::string& script, const char* text = nullptr) : context(quiet()) {
    if (text) write_file(scratch / script, text);
    RunRequest request;
    request.mission = scratch / script;
    mission = resolve_mission(request, RunKind::settle, context);
    pile = std::make_unique<InspectedPile>(mission, 1);
  }
  static RunOptions quiet() {
    RunOptions options;
    options.quiet = true, options.threads = 1;
    return options;
  }
  RunContext context;
  ResolvedMission mission;
  std::unique_ptr<InspectedPile> pile;
};

std::uint64_t settled_hash(InspectedPile& pile, const InspectedPile::Between& between = [] { return true; }) {
  pile.settle(between);
  return pile.rested().state_hash();
}

TEST(InspectedPile, SettlesAsAnyPileAndAMomentOfItGoesOnWithTheSameBits) {
  const ScratchFolder scratch;
  Inspected whole(scratch, "m.lua", kBricks), watched(scratch, "m.lua");
  const std::uint64_t hash = settled_hash(*whole.pile);
  EXPECT_EQ(whole.pile->all_pieces().pieces.size(), 12u);
  int calls = 0;
  std::string moment;
  std::vector<Pose> then;
  EXPECT_EQ(settled_hash(*watched.pile,
                         [&] {
                           EXPECT_TRUE(calls > 0 || watched.pile->all_pieces().pieces.size() == 12u);
                           if (++calls == 40) {
                             EXPECT_TRUE(watched.pile->can_save());
                             moment = save_snapshot(watched.mission, watched.pile->checkpoint(), scratch.path().string(), "moment", "here");
                             for (const PieceState& piece : watched.pile->state().pieces) then.push_back(piece.world_from_body);
                           }
                           return true;
                         }),
            hash);
  ASSERT_EQ(moment, scratch / "moment.lua");
  // As the program goes on: from the same poses to the same rest.
  Inspected again(scratch, "moment.lua");
  ASSERT_TRUE(again.mission.provenance.snapshot.has_value());
  int first = 0;
  EXPECT_EQ(settled_hash(*again.pile, [&] { return ++first, true; }), hash);
  EXPECT_EQ(first, calls - 40 + 1);  // once before the first step
  const Outcome run = run_rubble("settle " + moment + " --quiet --out " + (scratch / "a"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Outcome from_start = run_rubble("settle " + (scratch / "m.lua") + " --quiet --out " + (scratch / "b"));
  ASSERT_EQ(from_start.exit_code, 0) << from_start.err;
  EXPECT_TRUE(read_file(scratch / "a/pile.bin") == read_file(scratch / "b/pile.bin"));
  EXPECT_NE(read_file(scratch / "a/manifest.json").find("\"snapshot\""), std::string::npos);
  EXPECT_EQ(run_rubble("verify " + (scratch / "a") + " --quiet").exit_code, 0);
  // Another pile's, and one that changed since.
  const Outcome other = run_rubble("settle " + moment + " --quiet --seed 6 --out " + (scratch / "c"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("pile.snapshot"), std::string::npos) << other.err;
}

TEST(InspectedPile, WhatIsPulledIsSavedAsItIsAndOtherThanUntouched) {
  const ScratchFolder scratch;
  Inspected pulled(scratch, "m.lua", kBricks);
  const std::uint64_t hash = settled_hash(*pulled.pile);
  // At rest: the pull begins before settling goes on.
  World& world = pulled.pile->world();
  MouseSpring spring;
  const Vec3 centre = world.piece(0).world_from_body * world.centre_of_mass(0);
  ASSERT_TRUE(spring.grab(world, 0, centre));
  spring.pull_to(centre + Vec3{0, 0, 1});
  const double step = pulled.mission.scenario.settle.step;
  const auto pull = [&] { world.apply_impulse(0, spring.point(world), spring.calc_impulse(world, step)); };
  pull();
  int steps = 0;
  pulled.pile->settle([&] {
    if (++steps < 40) pull();
    return steps < 60;
  });
  EXPECT_FALSE(pulled.pile->settled());
  const Vec3 lifted = world.piece(0).world_from_body.translation;
  save_snapshot(pulled.mission, pulled.pile->checkpoint(), scratch.path().string(), "moment", "pulled");
  const std::uint64_t after = settled_hash(*pulled.pile);
  EXPECT_NE(after, hash);
  Inspected again(scratch, "moment.lua");
  EXPECT_EQ(settled_hash(*again.pile), after);
  EXPECT_GT(lifted.z, centre.z + 0.05);
}

TEST(InspectedPile, SnapshotsThatAreNotThereAreErrorsWithTheirLine) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", "return rubble.mission {\n  pile = { layers = 1, pieces_per_layer = 1, mix = { { asset = \"brick\" } },\n"
                                "    snapshot = \"no.state\" },\n}\n");
  const Outcome none = run_rubble("settle " + (scratch / "m.lua") + " --quiet --out " + (scratch / "a"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("m.lua:3: pile.snapshot: no such file"), std::string::npos) << none.err;
  write_file(scratch / "no.state", "something else");
  const Outcome foreign = run_rubble("settle " + (scratch / "m.lua") + " --quiet --out " + (scratch / "a"));
  EXPECT_EQ(foreign.exit_code, 1);
  EXPECT_NE(foreign.err.find("no.state"), std::string::npos) << foreign.err;
}

// A table: a slab on two walls, under which a ball of 0.15 m has room.
TEST(VoidSurvey, MapsInTheBackgroundAndShowsWhereTheBallFits) {
  const ScratchFolder scratch;
  Inspected table(scratch, "m.lua", R"(return rubble.mission {
    pile = { layers = 0, placed = {
      { box = { 0.2, 2, 0.6 }, position = { -0.6, 0, 0.3 } }, { box = { 0.2, 2, 0.6 }, position = { 0.6, 0, 0.3 } },
      { box = { 1.6, 2, 0.2 }, position = { 0, 0, 0.7 } } } },
    voids = { on = true, voxel = 0.05, radius = 0.15 },
  })");
  settled_hash(*table.pile);
  VoidSurvey survey(table.mission.scenario.voids, table.mission.assets);
  EXPECT_EQ(survey.map(), nullptr);
  survey.start(table.pile->state(), table.pile->world().steps(), 1);
  while (survey.working()) std::this_thread::yield();
  const VoidMap* const map = survey.map();
  ASSERT_NE(map, nullptr);
  EXPECT_EQ(survey.progress(), 1);
  std::vector<OverlayLine> lines;
  add_voids(*map, lines);
  ASSERT_GT(lines.size(), 30u);
  for (const OverlayLine& line : lines) {
    const Vec3 at = (line.from + line.to) * 0.5;
    if (line.colour == std::array<std::uint8_t, 3>{255, 255, 255}) continue;  // an entrance
    EXPECT_LT(std::fabs(at.x), 0.5 - 0.1) << "between the walls";
    EXPECT_LT(at.z, 0.6 - 0.1) << "below the slab";
  }
  survey.start(table.pile->state(), 0, 1);
  survey.forget();  // under way
  EXPECT_EQ(survey.map(), nullptr);
}

}  // namespace inspect_test
}  // namespace rubble::testing
