// Robots feel what stands about a pile.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "kernel/base/error.h"
#include "kernel/queries/queries.h"
#include "kernel/robot/drive_commands.h"
#include "kernel/robot/robot_run.h"
#include "kernel/surroundings/make_surroundings.h"
#include "kernel/geometry/mesh_builder.h"
#include "scripting/robots/rover.h"
#include "kernel/world/world_robots.h"

namespace rubble {
namespace robot_surroundings_test {

// One box with this look, of this kind. leafy: as trees are.
std::shared_ptr<const Surroundings> box(const Vec3& low, const Vec3& high, const std::string& look = "concrete_cast",
                                        SurroundingKind kind = SurroundingKind::building, bool leafy = false) {
  MeshBuilder builder;
  builder.look(look);
  builder.box(low, high);
  auto mesh = std::make_shared<SurroundingMesh>();
  mesh->levels = {builder.take()};
  mesh->leafy = leafy;
  auto surroundings = std::make_shared<Surroundings>();
  surroundings->meshes = {mesh};
  surroundings->things = {{kind, 0, {}, 1}};
  return surroundings;
}

PileState empty_pile(std::shared_ptr<const Surroundings> surroundings) {
  PileState state;
  state.surroundings = std::move(surroundings);
  return state;
}

// A rover that drives straight on, from there; seen is called with its base after each step.
RobotRunResult drive(std::shared_ptr<const Surroundings> surroundings, const Vec3& from, double speed, double duration,
                     const std::function<void(const Pose&)>& seen = {}, int threads = 1) {
  RobotRunOptions options;
  options.duration = duration, options.threads = threads;
  RobotRun run(Pile{}, empty_pile(std::move(surroundings)), options);
  const RobotModel model = make_rover({});
  run.add(model, {Quat{}, from}, [&](const RobotSense&) { return drive_sides(model, speed, 0); });
  return run.run([&](double) {
    if (seen) seen(run.world().robots().state(0).links[0].world_from_link);
    return true;
  });
}

double end_of(std::shared_ptr<const Surroundings> surroundings) {
  double x = 0;
  drive(std::move(surroundings), {0, 0, 0.001}, 0.5, 6, [&](const Pose& base) { x = base.translation.x; });
  return x;
}

TEST(RobotSurroundings, ARoverClimbsAKerbAndStandsOnIt) {
  double x = 0, z = 0;
  drive(box({1, -2, 0}, {5, 2, 0.04}), {0, 0, 0.001}, 0.5, 6, [&](const Pose& base) {
    x = base.translation.x, z = base.translation.z;
  });
  EXPECT_GT(x, 1.5);
  EXPECT_NEAR(z, 0.04, 0.002);
}

TEST(RobotSurroundings, AWallStopsARoverAndFoliageAndTheSkylineDoNot) {
  const Vec3 low{1, -2, 0}, high{1.3, 2, 1};
  EXPECT_LT(end_of(box(low, high)), 1);
  EXPECT_LT(end_of(box(low, high, "asphalt", SurroundingKind::tree, true)), 1) << "a trunk";
  EXPECT_GT(end_of(box(low, high, "leaves", SurroundingKind::tree, true)), 2);
  EXPECT_GT(end_of(box(low, high, "concrete_cast", SurroundingKind::skyline)), 2);
  EXPECT_GT(end_of(nullptr), 2);
}

TEST(RobotSurroundings, ARobotInAWallIsAMistakeThatNamesThem) {
  try {
    drive(box({-0.1, -2, 0}, {0.1, 2, 1}), {0, 0, 0.001}, 0, 1);
    FAIL() << "it stands in a wall";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("deep in the surroundings"), std::string::npos) << error.what();
  }
}

// On the asphalt of a real street, with its camber and unevenness: never more than these above or below what queries
// know of the same triangles.
TEST(RobotSurroundings, ARoverFollowsTheRoad) {
  SurroundingsSpec spec;
  spec.type = SurroundingsType::street;
  spec.reach = 60, spec.vehicles = 0;
  const auto street = std::make_shared<const Surroundings>(make_surroundings(spec, 3, {0, 0, 4}, false, 0));
  const PileQueries queries(empty_pile(street), {});
  // A lane beside the crown: the circle, its clearance, 0.5 m, the pavement, half of the road.
  const double middle = -(4 + spec.clearance) - 0.5 - 2.5 - 5.25 + 1.5;
  const auto height_at = [&](const Vec3& p) {
    const auto hit = queries.cast_ray({p.x, p.y, p.z + 1}, {0, 0, -1}, 3);
    return hit ? p.z + 1 - hit->distance : -1;
  };
  const Vec3 start{0, middle, height_at({0, middle, 0}) + 0.02};
  double worst = 0, least = 1, most = 0;
  RobotRunResult results[2];
  for (int threads = 1; threads <= 2; ++threads) {
    int steps = 0;
    results[threads - 1] = drive(street, start, 0.8, 8, [&](const Pose& base) {
      if (++steps < 120) return;  // until it stands
      const double height = height_at(base.translation);
      worst = std::max(worst, std::abs(base.translation.z - height));
      least = std::min(least, height), most = std::max(most, height);
    }, threads);
  }
  EXPECT_EQ(results[0].hash(), results[1].hash());
  EXPECT_GT(results[0].robots[0].distance, 5);
  EXPECT_GT(most - least, 0.003) << "a road that is level shows nothing";
  EXPECT_LT(worst, 0.005);
  std::printf("within %.1f mm of the road, which rises and falls by %.1f mm\n", worst * 1e3, (most - least) * 1e3);
}

}  // namespace robot_surroundings_test
}  // namespace rubble
