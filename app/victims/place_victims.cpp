#include "app/victims/place_victims.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/planning/pile_survey.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"

namespace rubble {

VoidSpaceOptions victim_space_options(double radius) {
  VoidSpaceOptions options;
  options.voxel = std::min(radius, std::max(0.05, 0.5 * radius));
  options.rolling_radius = outside_radius_for(options.rolling_radius, radius);
  return options;
}

std::vector<VictimPlace> find_victim_places(const VoidMap& map, VictimDifficulty difficulty) {
  std::vector<VictimPlace> all;
  for (const Void& v : map.robots.front().voids) {
    if (v.entrances.empty()) continue;
    const std::vector<double> ways = calc_ways_in(map.space, v);
    auto way = ways.begin();
    for (const std::uint32_t place : v.places) {
      if (std::isfinite(*way) && *way >= kLeastWayIn) all.push_back({map.space.grid.centre(place), *way});
      ++way;
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const VictimPlace& a, const VictimPlace& b) { return a.way_in < b.way_in; });
  const auto third = std::size_t(difficulty);
  const auto at = [&](std::size_t k) { return all.begin() + std::ptrdiff_t(all.size() * k / 3); };
  return {at(third), at(third + 1)};
}

namespace {

// Their heads, in the frames of the assets, whose origin is the middle of the trunk; unit: m.
// assets/generator/victim_pieces.cpp has the figures.
const std::map<std::string, Vec3> kHeads{{"victim_supine", {0.53, 0, 0.02}},
                                         {"victim_prone", {0.52, 0.03, -0.01}},
                                         {"victim_curled", {0.5, 0.12, -0.02}},
                                         {"victim_sitting", {-0.06, 0, 0.53}}};

constexpr int kTriesEach = 300;      // places that are tried for one victim
constexpr int kRounds = 4;           // of looking whether all can be reached
constexpr double kDrop = 0.03;       // above what is below; unit: m
constexpr double kGap = 0.005;       // between a figure and everything else before it falls; unit: m
constexpr double kApart = 1.2;       // between the trunks of two; unit: m
constexpr double kFarthest = 0.6;    // that one may slide from where it was put; unit: m
constexpr double kMostOverlap = 0.01;  // with anything, at rest; unit: m
constexpr double kFallingTime = 5;   // unit: s
constexpr double kRestSpeed = 0.005, kRestTurning = 0.02;  // unit: m/s, rad/s
constexpr double kGravity = 9.81;    // where the mission has none; unit: m/s2
constexpr double kDeepest = 3;       // from a place down to what a victim lies on; unit: m

struct Figure {
  int type = 0;
  std::vector<Vec3> corners;  // of its coarsest mesh
  double lowest = 0;          // of the corners; unit: m
};

std::vector<Figure> find_figures(const AssetLibrary& assets) {
  std::vector<Figure> figures;
  for (const auto& [name, head] : kHeads) {
    Figure figure;
    figure.type = assets.find(name).index;
    for (const Vec3f& p : assets.meshes[std::size_t(figure.type)]->levels.back().positions)
      figure.corners.push_back(Vec3(p));
    for (const Vec3& p : figure.corners) figure.lowest = std::min(figure.lowest, p.z);
    figures.push_back(std::move(figure));
  }
  return figures;
}

class Placer {
 public:
  Placer(const VictimScenario& victims, std::uint64_t seed, double gravity, const AssetLibrary& assets, int threads,
         PileState& pile)
      : victims_(victims), gravity_(gravity > 0 ? gravity : kGravity), assets_(assets), threads_(threads), pile_(pile),
        first_(pile.pieces.size()), random_(seed, "victims"), figures_(find_figures(assets)) {
    PileSurvey survey(assets, pile, threads);
    places_ = find_victim_places(look_for_voids(survey), victims.difficulty);
    lay();
  }

  void run() {
    for (int round = 0; round < kRounds; ++round) {
      while (count() < victims_.count && place_one()) {
      }
      drop_unreachable();
      if (count() == victims_.count) return;
    }
    throw InputError({"", 0, "victims.count", "the voids cannot hold so many victims",
                      "at most " + std::to_string(count()) + " in this pile", std::to_string(victims_.count),
                      "another seed, difficulty or radius, or a pile with larger voids (rubble.collapse)"});
  }

 private:
  int count() const { return int(pile_.pieces.size() - first_); }

  const VoidMap& look_for_voids(PileSurvey& survey) const {
    return survey.find_voids(victim_space_options(victims_.radius), {victims_.radius});
  }

  // All that lies there, as rock.
  void lay() {
    WorldOptions options;
    options.gravity = gravity_;
    options.threads = 1;
    world_ = std::make_unique<World>(assets_.types, options, assets_.assemblies);
    Pile types;
    types.types = assets_.types, types.assemblies = assets_.assemblies;
    world_->lay(types, pile_, true);
    laid_ = world_->snapshot();
    queries_ = std::make_unique<PileQueries>(pile_, assets_.finest_meshes());
  }

  bool place_one() {
    for (int i = 0; i < kTriesEach && !places_.empty(); ++i) {
      const VictimPlace& place = places_[random_.below(places_.size())];
      const Figure& figure = figures_[random_.below(figures_.size())];
      const std::optional<Pose> put = find_fit(place, figure, random_.uniform(-portable::kPi, portable::kPi));
      const std::optional<PieceState> rests = put ? let_fall(figure, *put) : std::nullopt;
      if (!rests) continue;
      pile_.pieces.push_back(*rests);
      lay();
      return true;
    }
    return false;
  }

  // On what is below the place, if the figure has room there.
  std::optional<Pose> find_fit(const VictimPlace& place, const Figure& figure, double yaw) const {
    const auto below = queries_->cast_ray(place.position, {0, 0, -1}, kDeepest);
    if (!below) return {};
    Pose pose{{portable::cos(0.5 * yaw), 0, 0, portable::sin(0.5 * yaw)}, below->point};
    pose.translation.z += kDrop - figure.lowest;
    for (std::size_t i = first_; i < pile_.pieces.size(); ++i)
      if (distance(pile_.pieces[i].world_from_body.translation, pose.translation) < kApart) return {};
    for (const Vec3& corner : figure.corners)
      if (queries_->clearance(pose * corner, 2 * kGap) < kGap) return {};
    return pose;
  }

  // Nothing when it slides away or comes to lie in something.
  std::optional<PieceState> let_fall(const Figure& figure, const Pose& pose) {
    world_->restore(*laid_);
    NewPiece piece;
    piece.placement = {figure.type, 1, pose, false};
    const int index = world_->add({piece});
    const double end = world_->time() + kFallingTime;
    bool rests = false;
    while (!rests && world_->time() < end) {
      world_->step();
      rests = world_->is_touching(index) && world_->rest().reached(kRestSpeed, kRestTurning);
    }
    PieceState found = world_->piece(index);
    if (!rests || found.status == PieceStatus::lost || world_->diagnostics().deepest_overlap().depth > kMostOverlap ||
        distance(found.world_from_body.translation, pose.translation) > kFarthest)
      return {};
    found.linear_velocity = found.angular_velocity = {};
    found.status = PieceStatus::resting;
    return found;
  }

  // Those that no robot gets near to and sees now that all lie there.
  void drop_unreachable() {
    if (count() == 0) return;
    PileSurvey survey(assets_, pile_, threads_);
    const VoidMap& map = look_for_voids(survey);
    std::vector<Vec3> reached;
    for (const Void& v : map.robots.front().voids)
      for (const std::uint32_t i : v.places)
        if (!v.entrances.empty()) reached.push_back(map.space.grid.centre(i));
    std::vector<int> lost;
    for (const Victim& victim : find_victims(pile_)) {
      const auto sees = [&](const Vec3& place) { return sees_victim(*queries_, place, victim); };
      if (victim.piece >= int(first_) && std::none_of(reached.begin(), reached.end(), sees)) lost.push_back(victim.piece);
    }
    for (auto i = lost.rbegin(); i != lost.rend(); ++i) pile_.pieces.erase(pile_.pieces.begin() + *i);
    if (!lost.empty()) lay();
  }

  const VictimScenario& victims_;
  double gravity_;
  const AssetLibrary& assets_;
  int threads_;
  PileState& pile_;
  std::size_t first_;  // the first victim's number
  RandomStream random_;
  std::vector<Figure> figures_;
  std::vector<VictimPlace> places_;
  std::unique_ptr<World> world_;
  std::shared_ptr<const World::Snapshot> laid_;
  std::unique_ptr<PileQueries> queries_;
};

}  // namespace

void place_victims(const VictimScenario& victims, std::uint64_t seed, double gravity, const AssetLibrary& assets,
                   int threads, PileState& pile) {
  if (victims.count > 0) Placer(victims, seed, gravity, assets, threads, pile).run();
}

bool sees_victim(const PileQueries& queries, const Vec3& place, const Victim& victim) {
  if (distance(place, victim.trunk) > kVictimNear) return false;
  for (const Vec3& target : {victim.trunk, victim.head}) {
    if (distance(place, target) == 0) continue;
    const auto hit = queries.cast_ray(place, target - place, 2 * kVictimNear);
    if (hit && hit->piece == victim.piece) return true;
  }
  return false;
}

std::vector<Victim> find_victims(const PileState& pile) {
  std::vector<Victim> victims;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    const auto head = kHeads.find(pile.types[std::size_t(piece.type)]);
    if (head == kHeads.end() || piece.status == PieceStatus::lost) continue;
    const Pose& pose = piece.world_from_body;
    victims.push_back({int(i), head->first, pose.translation, pose * (head->second * piece.scale)});
  }
  return victims;
}

void list_victims(const PileState& state, int count, Pile& pile) {
  if (count == 0) return;
  Layer layer;
  for (std::size_t i = state.pieces.size() - std::size_t(count); i < state.pieces.size(); ++i)
    layer.pieces.push_back({state.pieces[i].type, state.pieces[i].scale, state.pieces[i].world_from_body, false});
  pile.layers.push_back(std::move(layer));
}

std::string describe_victims(const std::vector<Victim>& victims) {
  nlohmann::ordered_json json;
  json["victims"] = nlohmann::ordered_json::array();
  for (const Victim& victim : victims) {
    nlohmann::ordered_json one;
    one["piece"] = victim.piece;
    one["asset"] = victim.asset;
    one["trunk"] = {victim.trunk.x, victim.trunk.y, victim.trunk.z};
    one["head"] = {victim.head.x, victim.head.y, victim.head.z};
    json["victims"].push_back(one);
  }
  return json.dump(2) + "\n";
}

}  // namespace rubble
