#include "io/voids/void_files.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/base/hash.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

double round_to(double value, double unit) {
  const double rounded = std::round(value / unit);
  return rounded == 0 ? 0 : rounded / (1 / unit);
}
double length(double value) { return round_to(value, 1e-4); }
double volume(double value) { return round_to(value, 1e-6); }
Json point(const Vec3& p) { return Json::array({length(p.x), length(p.y), length(p.z)}); }

Json entrance(const Entrance& e) {
  return {{"position", point(e.position)},
          {"inward", point(e.inward)},
          {"radius", length(e.radius)},
          {"area", round_to(e.area, 1e-4)}};
}

Json describe(const Void& v, std::size_t rank) {
  Json entrances = Json::array();
  for (const Entrance& e : v.entrances) entrances.push_back(entrance(e));
  Json json{{"rank", rank},
            {"volume", volume(v.volume)},
            {"widest", point(v.widest)},
            {"widest_radius", length(v.widest_radius)},
            {"deepest", point(v.deepest)},
            {"path_length", length(v.path_length)},
            {"depth", length(v.depth)},
            {"bottleneck_radius", length(v.bottleneck_radius)}};
  json["bottleneck"] = v.bottleneck_radius > 0 ? point(v.bottleneck) : Json(nullptr);
  json["entrances"] = entrances;
  return json;
}

Json describe(const RobotVoids& robot) {
  Json voids = Json::array();
  for (std::size_t i = 0; i < robot.voids.size(); ++i)
    voids.push_back(describe(robot.voids[i], i + 1));
  const double share = robot.volume > 0 ? robot.reachable_volume / robot.volume : 0;
  return {{"radius", robot.radius},
          {"volume", volume(robot.volume)},
          {"reachable_volume", volume(robot.reachable_volume)},
          {"reachable_share", length(share)},
          {"voids", voids}};
}

Json describe(const VoidGraph& graph) {
  Json chambers = Json::array(), throats = Json::array();
  for (const Chamber& c : graph.chambers) {
    chambers.push_back({{"position", point(c.position)},
                        {"radius", length(c.radius)},
                        {"volume", volume(c.volume)}});
  }
  for (const Throat& t : graph.throats) {
    throats.push_back({{"a", t.a},
                       {"b", t.b < 0 ? Json("outside") : Json(t.b)},
                       {"position", point(t.position)},
                       {"radius", length(t.radius)}});
  }
  return {{"chambers", chambers}, {"throats", throats}};
}

}  // namespace

std::string make_void_json(const VoidMap& map) {
  const VoxelGrid& grid = map.space.grid;
  Json robots = Json::array();
  for (const RobotVoids& robot : map.robots) robots.push_back(describe(robot));
  const Json json{{"format", 1},
                  {"pile_state_hash", hex64(map.space.pile_state)},
                  {"voxel", grid.voxel},
                  {"rolling_radius", map.space.rolling_radius},
                  {"grid", {{"corner", point(grid.corner)}, {"size", grid.size}}},
                  {"solid_volume", volume(map.solid_volume)},
                  {"void_volume", volume(map.void_volume)},
                  {"covered_volume", volume(map.covered_volume)},
                  {"robots", robots},
                  {"graph", describe(map.graph)}};
  return json.dump(1) + "\n";
}

}  // namespace rubble
