#include "bench/verification/variants.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/assets/asset_library.h"
#include "app/measures/metrics.h"
#include "app/planning/pile_survey.h"
#include "app/scene/build_scene.h"
#include "bench/ejection_watch.h"
#include "bench/process_times.h"
#include "kernel/robot/drive_commands.h"
#include "kernel/robot/robot_run.h"
#include "kernel/settling/furnish.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world_rest.h"
#include "scripting/mission.h"
#include "scripting/robots/crawler.h"

namespace rubble {
namespace {

constexpr Variant kPileDefault{60, 16}, kRobotDefault{240, 4};
constexpr double kVoidVoxel = 0.05, kRobotRadius = 0.1;  // unit: m
constexpr double kAwake = 0.5;                           // with all pieces awake before forces are measured; unit: s
constexpr double kDrive = 8, kSpeed = 0.4;               // unit: s, m/s

struct VerifiedWork {
  const char* name;
  const char* file;  // relative to the sources
  std::vector<std::string> overrides;
  bool robot;
  const char* text;
};

const std::vector<VerifiedWork>& works() {
  static const std::vector<VerifiedWork> all{
      {"loose", "bench/equilibrium/concrete.lua", {"pile.layers=2", "pile.pieces_per_layer=100", "pile.spawn_bounds={4,4,8}"}, false, "2 x 100 pieces of concrete"},
      {"wood", "bench/equilibrium/residential.lua", {"pile.layers=2", "pile.pieces_per_layer=80", "pile.spawn_bounds={4,4,8}"}, false, "2 x 80 pieces of a house"},
      {"mixed", "bench/equilibrium/mixed.lua", {"pile.layers=2", "pile.pieces_per_layer=80", "pile.spawn_bounds={5,5,8}"}, false, "2 x 80 pieces of four packs"},
      {"lean_to", "scripts/collapse/lean_to.lua", {}, false, "slabs that lean on a wall, 2 x 80 pieces on them"},
      {"ruin", "bench/verification/ruin.lua", {}, false, "a building of two storeys that comes down"},
      {"robot", "bench/equilibrium/residential.lua", {"pile.layers=1", "pile.pieces_per_layer=60", "pile.spawn_bounds={5,5,6}"}, true,
       "a crawler that drives against and over 60 pieces of a house for 8 s"}};
  return all;
}

const VerifiedWork& find_work(const std::string& name) {
  for (const VerifiedWork& work : works())
    if (name == work.name) return work;
  throw InputError({"", 0, "--work", "unknown work", "one of:\n" + describe_verified_works(), "\"" + name + "\"", ""});
}

// Sorted; share: 0 to 1.
double quantile(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0 : sorted[std::min(sorted.size() - 1, std::size_t(share * double(sorted.size())))];
}

// The largest speed sideways or upwards of each piece so far.
void note_throws(const World& world, std::vector<double>& fastest) {
  fastest.resize(std::size_t(world.size()), 0);
  for (int i = 0; i < world.size(); ++i) {
    if (!world.is_awake(i)) continue;
    const Vec3 v = world.piece(i).linear_velocity;
    fastest[std::size_t(i)] = std::max({fastest[std::size_t(i)], std::hypot(v.x, v.y), v.z});
  }
}

void add_throws(std::vector<double> fastest, Record& record) {
  std::sort(fastest.begin(), fastest.end());
  record["throw_90"] = quantile(fastest, 0.9);
  record["throw_99"] = quantile(fastest, 0.99);
  record["ejected"] = int(fastest.end() - std::upper_bound(fastest.begin(), fastest.end(), kEjectionSpeed));
}

// Forces between pairs of pieces, and between pieces and the ground, in the last step.
void add_forces(const World& world, double step, double gravity, Record& record) {
  std::map<std::pair<int, int>, Vec3> pairs;
  for (const ContactImpulse& contact : world.contacts()) pairs[{contact.piece, contact.other}] += contact.impulse;
  double mass = 0;
  int movable = 0;
  for (int i = 0; i < world.size(); ++i) mass += world.mass(i), movable += world.mass(i) > 0;
  const double weight = gravity * mass / std::max(movable, 1);
  std::vector<double> forces;
  for (const auto& [pair, impulse] : pairs) forces.push_back(std::sqrt(dot(impulse, impulse)) / step / weight);
  std::sort(forces.begin(), forces.end());
  double sum = 0;
  for (const double force : forces) sum += force;
  record["contacts_a_piece"] = double(forces.size()) / std::max(movable, 1);
  record["force_mean"] = forces.empty() ? 0 : sum / double(forces.size());
  record["force_median"] = quantile(forces, 0.5);
  record["force_90"] = quantile(forces, 0.9);
  record["force_99"] = quantile(forces, 0.99);
}

void add_shape(const PileState& state, const AssetLibrary& assets, int threads, Record& record) {
  Metrics metrics;
  add_pile_metrics(state, assets, metrics);
  VoidScenario voids;
  voids.voxel = kVoidVoxel, voids.radius = kRobotRadius;
  PileSurvey survey(assets, state, threads);
  add_void_metrics(survey.find_voids(make_void_options(voids), {voids.radius}), voids.radius, metrics);
  double height = 0;
  int movable = 0;
  for (const PieceState& piece : state.pieces) {
    if (piece.status == PieceStatus::lost || piece.status == PieceStatus::fixed) continue;
    height += piece.world_from_body.translation.z, ++movable;
  }
  record["top_m"] = metrics["pile_height_m"];
  record["mean_height_m"] = height / std::max(movable, 1);
  record["radius_m"] = metrics["pile_radius_m"];
  const double covered = metrics["void_covered_m3"];
  record["covered_m3"] = covered;
  record["porosity"] = covered / (covered + metrics["piece_volume_m3"]);
  record["void_m3"] = metrics["void_volume_m3"];
  record["robot_void_m3"] = metrics["void_robot_m3"];
}

void add_pile(const Pile& pile, const AssetLibrary& assets, const SettleOptions& options, int substeps, Record& record) {
  World world(pile.types, calc_world_options(options), pile.assemblies);
  world.set_step(options.step, substeps);
  std::vector<double> throws;
  const PileState state = settle_pile(world, pile, options, {}, [&](const World& w) { note_throws(w, throws); });
  add_throws(throws, record);
  record["settled"] = state.settled;
  record["lost"] = state.lost;
  record["rest_s"] = state.simulated;
  add_shape(state, assets, options.threads, record);
  world.set_sleeping(false);
  for (long i = std::lround(kAwake / options.step); i > 0; --i) world.step();
  double drift = 0;
  for (int i = 0; i < world.size(); ++i)
    if (state.pieces[std::size_t(i)].status != PieceStatus::lost)
      drift = std::max(drift, distance(world.piece(i).world_from_body.translation, state.pieces[std::size_t(i)].world_from_body.translation));
  record["drift_m"] = drift;
  add_forces(world, options.step, options.gravity, record);
}

// Where a crawler that drives along X has nothing under it and the first piece right before it; unit: m
double find_start(const Pile& pile, const PileState& state) {
  constexpr double kHalfWidth = 0.4, kHalfLength = 0.6;  // of a crawler with its flippers, and some; unit: m
  double first = 0;
  for (const PieceState& piece : state.pieces) {
    const Aabb box = calc_bounds(pile.types[std::size_t(piece.type)]);
    const double reach = piece.scale * std::max(norm(box.min), norm(box.max));
    const Vec3 p = piece.world_from_body.translation;
    if (piece.status != PieceStatus::lost && std::abs(p.y) < reach + kHalfWidth) first = std::min(first, p.x - reach);
  }
  return first - kHalfLength;
}

void add_robot(const Pile& pile, const PileState& state, const SettleOptions& settle, const Variant& variant, Record& record) {
  RobotRunOptions options;
  options.duration = kDrive;
  options.step = 1.0 / variant.step_hz, options.substeps = variant.substeps;
  options.gravity = settle.gravity, options.threads = settle.threads;
  RobotRun run(pile, state, options);
  const RobotModel crawler = make_crawler();
  run.add(crawler, {{}, {find_start(pile, state), 0, 0.002}}, [&](const RobotSense&) { return drive_sides(crawler, kSpeed, 0); });
  const RobotRunResult result = run.run();
  const RobotSummary& robot = result.robots.front();
  record["settled"] = true;
  record["distance_m"] = robot.distance, record["path_m"] = robot.path;
  record["work_j"] = robot.work, record["stuck_s"] = robot.stuck_time;
  record["pieces_moved"] = result.pieces_moved;
}

}  // namespace

std::vector<std::string> verified_works() {
  std::vector<std::string> names;
  for (const VerifiedWork& work : works()) names.push_back(work.name);
  return names;
}

std::string describe_verified_works() {
  std::string text;
  for (const VerifiedWork& work : works()) text += "  " + std::string(work.name) + ": " + work.text + "\n";
  return text;
}

std::vector<Variant> variants_of(const std::string& work) {
  const bool robot = find_work(work).robot;
  const Variant usual = robot ? kRobotDefault : kPileDefault;
  std::vector<Variant> variants{usual};
  for (const int hz : {60, 120, 240, 480, 960})
    if (hz != usual.step_hz) variants.push_back({hz, usual.substeps});
  for (const int substeps : robot ? std::vector<int>{1, 2, 8, 16} : std::vector<int>{4, 8, 32, 64})
    variants.push_back({usual.step_hz, substeps});
  return variants;
}

std::string name_of(const std::string& work, const Variant& variant) {
  return work + "@" + std::to_string(variant.step_hz) + "x" + std::to_string(variant.substeps);
}

Record measure(const std::string& work, std::uint64_t seed, const Variant& variant, int threads) {
  const VerifiedWork& of = find_work(work);
  MissionOptions mission_options;
  mission_options.seed = seed;
  mission_options.overrides = of.overrides;
  const Mission mission = load_mission(std::string(RUBBLE_SOURCE_DIR "/") + of.file, mission_options);
  const AssetLibrary assets = load_assets(mission, {});
  const Pile pile = generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets));
  SettleOptions options = mission.scenario.settle;
  options.threads = threads;
  Record record{{"work", name_of(work, variant)}, {"seed", seed}, {"of", work}, {"step_hz", variant.step_hz}, {"substeps", variant.substeps}};
  const Times begin = read_times();
  if (of.robot) {
    add_robot(pile, settle_pile(pile, options), options, variant, record);
  } else {
    options.step = 1.0 / variant.step_hz;
    add_pile(pile, assets, options, variant.substeps, record);
  }
  record["cpu_s"] = (read_times() - begin).cpu;
  return record;
}

}  // namespace rubble
