#include "app/navigate/navigation_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/scene/build_scene.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/voids/void_path.h"
#include "scripting/sensors/lidar.h"

namespace rubble {
namespace {

constexpr double kVoxel = 0.1;       // of the map of voids; unit: m
constexpr double kNearest = 0.5, kFarthest = 4;  // before an entrance, where the robot may stand; unit: m
constexpr double kBeside = 1;        // of an entrance's widest place, the ball enters on the ground; unit: m
constexpr double kApart = 2;         // the end of the way through the void is so far from its entrance; unit: m
constexpr double kAround = 4;        // the pile is mapped, too; unit: m

VoidMap make_map(const ResolvedMission& mission, const PileState& pile, double radius, int threads) {
  VoidSpaceOptions options;
  options.voxel = kVoxel;
  options.rolling_radius = outside_radius_for(options.rolling_radius, radius);
  options.scenery = mission.assets.terrain();
  options.threads = threads;
  return find_voids(calc_void_space(pile, mission.assets.finest_meshes(), options), {radius});
}

Vec3 on_ground(const Vec3& place) { return {place.x, place.y, 0}; }

}  // namespace

// An entrance with the place on the ground before it where the robot has room.
struct NavigationWorld::Door {
  Vec3 inner, outer;  // outer: at z = 0
};

NavigationWorld::NavigationWorld(const ResolvedMission& mission, const PileState& pile, const NavigationRules& rules,
                                 int threads)
    : rules_(rules), mission_(mission), pile_(pile), threads_(threads),
      ray_world_(std::make_shared<RayWorld>(build_scene(mission.scenario, mission.assets, pile))),
      queries_(pile, mission.assets.finest_meshes()), map_(make_map(mission, pile, rules.radius, threads)) {
  const VoxelGrid& grid = map_.space.grid;
  const Vec3 around{kAround, kAround, 0};
  bounds_.include(grid.corner - around);
  bounds_.include(grid.corner + Vec3(grid.size[0], grid.size[1], grid.size[2]) * grid.voxel + around);
  choose_void();
}

bool NavigationWorld::is_inside(const Vec3& base) const {
  const VoxelGrid& grid = map_.space.grid;
  const Cell cell = grid.find_cell(base + Vec3{0, 0, rules_.radius});
  return grid.contains(cell) && std::binary_search(inside_.begin(), inside_.end(), std::uint32_t(grid.index(cell)));
}

bool NavigationWorld::is_solid(const Vec3& place) const { return queries_.clearance(place, 0.01) == 0; }

// Of the standing robot, a few centimetres wider on all sides: looked for in balls that fill its box.
bool NavigationWorld::has_room(const Vec3& place, const Vec3& ahead) const {
  constexpr double kBall = 0.065;  // unit: m
  const Vec3 left{-ahead.y, ahead.x, 0};
  for (double x = -0.6; x < 0.62; x += 0.08)
    for (double y = -0.36; y < 0.4; y += 0.08)
      for (double z = 0.07; z < 0.5; z += 0.08)
        if (queries_.clearance(place + ahead * x + left * y + Vec3{0, 0, z}, 0.1) < kBall) return false;
  return true;
}

// Where the robot has room before an entrance, facing it: the nearest place straight ahead, else aside.
std::optional<Vec3> NavigationWorld::find_room(const Vec3& entrance, const Vec3& out) const {
  for (const double turn : {0.0, 0.5, -0.5, 1.0, -1.0}) {
    const double c = portable::cos(turn), s = portable::sin(turn);
    const Vec3 away{c * out.x - s * out.y, s * out.x + c * out.y, 0};
    for (double d = kNearest; d <= kFarthest; d += 0.1)
      if (has_room(entrance + away * d, away * -1.0)) return entrance + away * d;
  }
  return {};
}

// The nearest place beside another where the ball has room and lies on the ground.
std::optional<Vec3> NavigationWorld::find_low_place(const Vec3& beside) const {
  const VoxelGrid& grid = map_.space.grid;
  const Cell middle = grid.find_cell({beside.x, beside.y, rules_.radius + 0.5 * kVoxel});
  const int reach = int(kBeside / kVoxel);
  std::optional<Vec3> best;
  for (int y = middle[1] - reach; y <= middle[1] + reach; ++y)
    for (int x = middle[0] - reach; x <= middle[0] + reach; ++x) {
      const Cell cell{x, y, middle[2]};
      if (!grid.contains(cell) || double(map_.space.clearance[grid.index(cell)]) < rules_.radius) continue;
      const Vec3 place = grid.centre(cell);
      if (!best || distance(on_ground(place), on_ground(beside)) < distance(on_ground(*best), on_ground(beside)))
        best = place;
    }
  return best;
}

// Those on the ground, widest first.
std::vector<NavigationWorld::Door> NavigationWorld::find_doors(const Void& v) const {
  std::vector<Door> doors;
  for (const Entrance& e : v.entrances) {
    // Its position is where it is widest, which may be above the robot, or above debris.
    const std::optional<Vec3> inner = find_low_place(e.position);
    if (!inner) continue;
    const double flat = std::sqrt(e.inward.x * e.inward.x + e.inward.y * e.inward.y);
    if (flat < 0.5) continue;  // from above
    const Vec3 out{-e.inward.x / flat, -e.inward.y / flat, 0};
    if (const std::optional<Vec3> outer = find_room(on_ground(*inner), out)) doors.push_back({*inner, *outer});
  }
  return doors;
}

bool NavigationWorld::try_void(const Void& v) {
  const std::vector<Door> doors = find_doors(v);
  if (doors.empty()) return false;
  const Door& in = doors.front();
  const auto try_way = [&](const Vec3& inside, const std::vector<Vec3>& waypoints) {
    const FoundPath path = find_path(map_.space, in.inner, inside, rules_.radius);
    if (!path.found) return false;
    const Vec3 first = on_ground(in.inner), ahead = first - in.outer;
    const double half = 0.5 * portable::atan2(ahead.y, ahead.x);
    start_ = {{portable::cos(half), 0, 0, portable::sin(half)}, in.outer + Vec3{0, 0, 0.005}};
    waypoints_ = {first};
    waypoints_.insert(waypoints_.end(), waypoints.begin(), waypoints.end());
    shortest_ = distance(in.outer, first) + path.length + distance(on_ground(inside), waypoints.back());
    inside_.assign(v.cells.begin(), v.cells.end());
    return true;
  };
  for (std::size_t i = 1; i < doors.size(); ++i) {
    const Door& out = doors[i];
    if (distance(out.inner, in.inner) < kApart) continue;
    passes_ = try_way(out.inner, {on_ground(out.inner), out.outer});
    if (passes_) return true;
  }
  const std::optional<Vec3> end = find_low_place(v.deepest);
  return end && distance(*end, in.inner) >= kApart && try_way(*end, {on_ground(*end)});
}

void NavigationWorld::choose_void() {
  const std::vector<Void>& voids = map_.robots.front().voids;
  for (const Void& v : voids)
    if (try_void(v)) return;
  throw InputError({"", 0, "pile", "no void for the crawler",
                    "one that a ball of " + plain_text(rules_.radius) + " m enters from the ground, with room before it",
                    std::to_string(voids.size()) + " voids of another kind", "another pile or seed"});
}

namespace {

LidarFigures figures_of(const NavigationRules& rules) {
  LidarFigures figures;
  figures.model = LidarModel::os0, figures.channels = 32, figures.columns = 512;
  figures.rate_hz = 1 / rules.period;
  return figures;
}

}  // namespace

SensorItem make_range_scanner(const NavigationRules& rules, const std::string& name) { return make_lidar_item(name, figures_of(rules)); }

RangeScanner make_range_scanner(const NavigationWorld& world, std::uint64_t seed, std::function<Pose(double time)> world_from_base) {
  const Scenario& scenario = world.mission().scenario;
  const std::int64_t start = scenario.start_ns;
  const Pose base_from_scanner{{1, 0, 0, 0}, {0, 0, world.rules().scanner_height}};
  const auto place = [world_from_base = std::move(world_from_base), base_from_scanner, start](std::int64_t stamp) {
    return world_from_base(double(stamp - start) * 1e-9) * base_from_scanner;
  };
  return {figures_of(world.rules()).spec(), world.ray_world(), {place, start}, Medium(scenario.air, scenario.seed), seed, world.threads()};
}

}  // namespace rubble
