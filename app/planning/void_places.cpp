#include "app/planning/void_places.h"

#include <algorithm>
#include <set>
#include <utility>

#include "app/support/print.h"
#include "kernel/base/number_text.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr double kFinestVoxel = 0.02, kCoarsestVoxel = 0.1;  // unit: m
constexpr double kVoxelsPerRadius = 4, kLeastPerRadius = 2;

std::set<double> void_radii(const TrajectorySpec& spec) {
  std::set<double> radii;
  for (const Waypoint& w : spec.waypoints) {
    if (w.position_in_void) radii.insert(w.position_in_void->radius);
    if (w.look_at_in_void) radii.insert(w.look_at_in_void->radius);
  }
  return radii;
}

double outside_radius(const TrajectorySpec& spec) {
  double largest = 0;
  for (const Waypoint& w : spec.waypoints)
    for (const auto& place : {w.position_in_void, w.look_at_in_void})
      if (place) largest = std::max(largest, place->outside_radius);
  return largest;  // 0 without voids: there is room enough to go round the pile all the same
}

class Resolver {
 public:
  explicit Resolver(const VoidMap& map) : map_(map) {}

  Vec3 resolve(const VoidPlace& place, const std::string& key, ResolvedVoid& found) const {
    const Void& chosen = choose(place, key);
    found.radius = place.radius;
    found.volume = chosen.volume;
    found.way_in = chosen.path_length;
    return found.position = point_of(chosen, place);
  }

 private:
  const Void& choose(const VoidPlace& place, const std::string& key) const {
    std::vector<const Void*> open;
    for (const RobotVoids& robot : map_.robots)
      if (robot.radius == place.radius)
        for (const Void& v : robot.voids)
          if (!v.entrances.empty()) open.push_back(&v);
    if (place.order == VoidPlace::Order::depth)
      std::stable_sort(open.begin(), open.end(), [](const Void* a, const Void* b) {
        return a->path_length > b->path_length;
      });
    if (std::size_t(place.rank) <= open.size()) return *open[std::size_t(place.rank) - 1];
    const std::string sphere = "a sphere of radius " + exact_text(place.radius) + " m";
    throw InputError({"", 0, key, "no such void in this pile",
                      open.empty() ? "a void that " + sphere + " can enter"
                                   : "a rank from 1 to " + std::to_string(open.size()),
                      open.empty() ? "none" : "rank " + std::to_string(place.rank),
                      open.empty() ? "try a smaller radius, another seed or another collapse mode"
                                   : std::to_string(open.size()) + " voids let " + sphere + " in"});
  }

  static Vec3 point_of(const Void& v, const VoidPlace& place) {
    const Entrance& entrance = v.entrances.front();
    switch (place.point) {
      case VoidPlace::Point::entrance:
        return entrance.position;
      case VoidPlace::Point::approach: {
        Vec3 p = entrance.position - entrance.inward * place.distance;
        p.z = std::max(p.z, place.radius + 0.02);  // not below the ground
        return p;
      }
      case VoidPlace::Point::deepest:
        return v.deepest;
      case VoidPlace::Point::widest:
        return v.widest;
    }
    return v.widest;
  }

  const VoidMap& map_;
};

}  // namespace

PileSpace::PileSpace(PileSurvey& survey, const TrajectorySpec& spec, FlightProgress progress)
    : survey_(survey), progress_(std::move(progress)) {
  std::set<double> radii = void_radii(spec);
  robots_.assign(radii.begin(), radii.end());
  if (spec.plan == Plan::avoid || radii.empty()) radii.insert(spec.radius);
  options_.voxel = std::clamp(*radii.begin() / kVoxelsPerRadius, kFinestVoxel, kCoarsestVoxel);
  options_.voxel = std::min(options_.voxel, *radii.begin());
  options_.rolling_radius = outside_radius_for(outside_radius(spec), *radii.rbegin());
  options_.coarsest = *radii.begin() / kLeastPerRadius;  // so that they still tell where the sphere fits
}

const VoidMap& PileSpace::map() const {
  const VoidMap& map = survey_.find_voids(options_, robots_, [this](double done) {
    if (progress_) progress_(done, "free space");
    return true;
  });
  if (map.space.grid.voxel > options_.voxel && !told_)
    print_err("note: the free space of this pile is found in voxels of %.3g m, because those of %.3g m would take more than %.0f GiB of "
              "memory\n", map.space.grid.voxel, options_.voxel, options_.memory_limit / (1 << 30));
  told_ = true;
  return map;
}

std::vector<ResolvedVoid> resolve_places(const PileSpace& space, TrajectorySpec& spec) {
  std::vector<ResolvedVoid> all;
  for (std::size_t i = 0; i < spec.waypoints.size(); ++i) {
    Waypoint& w = spec.waypoints[i];
    const std::string key = "trajectory.waypoints[" + std::to_string(i + 1) + "]";
    const auto resolve = [&](std::optional<VoidPlace>& place, const char* name) {
      ResolvedVoid found;
      found.waypoint = int(i) + 1;
      const Vec3 position = Resolver(space.map()).resolve(*place, key + name, found);
      place.reset();
      all.push_back(found);
      return position;
    };
    if (w.position_in_void) w.position = resolve(w.position_in_void, ".position");
    if (w.look_at_in_void) w.look_at = resolve(w.look_at_in_void, ".look_at");
  }
  return all;
}

}  // namespace rubble
