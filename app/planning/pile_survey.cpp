#include "app/planning/pile_survey.h"

#include <algorithm>

namespace rubble {
namespace {

// Progress of one part of a task.
VoidProgress part_of(const VoidProgress& progress, double from, double to) {
  if (!progress) return {};
  return [=](double done) { return progress(from + (to - from) * done); };
}

bool has_robot(const VoidMap& map, double radius) {
  return std::any_of(map.robots.begin(), map.robots.end(),
                     [&](const RobotVoids& robot) { return robot.radius == radius; });
}

constexpr double kShareOfSpace = 0.7;  // of the time that all takes

}  // namespace

PileGeometry::PileGeometry(const AssetLibrary& assets, const PileState& state)
    : pile(state), meshes(assets.finest_meshes()), terrain(assets.terrain()),
      queries(state, meshes) {}

PileSurvey::PileSurvey(const AssetLibrary& assets, const PileState& pile, int threads)
    : assets_(assets), pile_(pile), threads_(threads) {}

const PileGeometry& PileSurvey::geometry() {
  if (!geometry_) geometry_ = std::make_unique<PileGeometry>(assets_, pile_);
  return *geometry_;
}

PileSurvey::Surveyed& PileSurvey::find_space(VoidSpaceOptions options, const VoidProgress& progress) {
  for (Surveyed& known : surveyed_)
    if (known.voxel == options.voxel && known.rolling_radius == options.rolling_radius) return known;
  options.threads = threads_;
  options.scenery = assets_.terrain();
  Surveyed made;
  made.voxel = options.voxel, made.rolling_radius = options.rolling_radius;
  made.map.space = calc_void_space(pile_, assets_.finest_meshes(), options, progress);
  ++spaces_made_;
  surveyed_.push_back(std::move(made));
  return surveyed_.back();
}

const VoidMap& PileSurvey::find_voids(const VoidSpaceOptions& options,
                                      const std::vector<double>& radii,
                                      const VoidProgress& progress) {
  Surveyed& found = find_space(options, part_of(progress, 0, kShareOfSpace));
  if (radii.empty()) return found.map;
  if (!found.connected) {
    found.map = rubble::find_voids(std::move(found.map.space), radii, part_of(progress, kShareOfSpace, 1));
    found.connected = true;
  }
  for (const double radius : radii) {
    if (has_robot(found.map, radius)) continue;
    found.map.robots.push_back(find_robot_voids(found.map.space, radius, threads_));
    add_bottlenecks(found.map.space, found.map.widest, found.map.robots.back());
  }
  return found.map;
}

}  // namespace rubble
