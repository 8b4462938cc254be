#include "tests/determinism/standard_scenes.h"

#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/random.h"
#include "kernel/settling/building_collapse.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "tests/kernel/scenes.h"

namespace rubble::determinism {
namespace {

using testing::at;
using testing::turned;

SceneResult result_of(const World& world) {
  PileState state;
  state.pieces = world.pieces();
  state.steps = world.steps();
  return {state.steps, state.state_hash()};
}

SceneResult step_world(std::vector<PieceType> types, std::vector<NewPiece> pieces, int steps,
                       const SceneOptions& options) {
  pieces.back().placement.world_from_body.translation.x += options.push;
  WorldOptions world_options;
  world_options.threads = options.threads;
  World world(std::move(types), world_options);
  world.add(pieces);
  for (int i = 0; i < steps; ++i) {
    world.step();
    if (options.after_step) options.after_step(world);
  }
  return result_of(world);
}

// Fixed pieces, compound ones among them, with two layers of 70 mixed pieces on top.
Pile standing_and_falling(std::uint64_t seed) {
  PileSpec spec = testing::small_pile(seed, 2, 70);
  const int culvert = int(spec.types.size());
  spec.types.push_back(testing::culvert_type());
  const auto place = [&spec](int type, const Vec3& position, const Quat& rotation, bool fixed) {
    spec.placed.push_back(at(type, position, rotation, fixed).placement);
  };
  place(culvert, {0.3, 0, 0.72}, turned({0, 0, 1}, 0.3), true);
  place(2, {-1.6, 0.2, 0.6}, turned({1, 0, 0}, 1.5), true);   // a slab as a wall
  place(6, {1.5, -1.2, 0.21}, turned({0, 0, 1}, 1.1), true);  // a pipe on the ground
  place(2, {1.4, 1.3, 0.3}, turned({0, 1, 0}, 0.2), false);
  return generate_pile(spec);
}

SceneResult settle(const Pile& pile, Schedule schedule, const SceneOptions& options) {
  SettleOptions settle_options;
  settle_options.schedule = schedule;
  settle_options.threads = options.threads;
  World world(pile.types, calc_world_options(settle_options), pile.assemblies);
  const PileState state = settle_pile(world, pile, settle_options, [&](const SettleProgress&) {
    if (options.after_step) options.after_step(world);
    return true;
  });
  return {state.steps, state.state_hash()};
}

Pile pushed(Pile pile, double push) {
  pile.layers[0].pieces[35].world_from_body.translation.x += push;
  return pile;
}

SceneResult pile_layers(const SceneOptions& options) {
  return settle(pushed(standing_and_falling(101), options.push), Schedule::layers, options);
}

SceneResult pile_planes(const SceneOptions& options) {
  return settle(pushed(standing_and_falling(102), options.push), Schedule::planes, options);
}

// In the middle of the impacts: most pieces move and turn fast.
SceneResult pile_midair(const SceneOptions& options) {
  const Pile pile = generate_pile(testing::small_pile(103, 1, 150));
  RandomStream random(103, "speeds");
  std::vector<NewPiece> pieces;
  for (const Placement& placement : pile.layers[0].pieces) {
    NewPiece piece;
    piece.placement = placement;
    piece.placement.world_from_body.translation.z += 0.4;
    piece.linear_velocity = random.direction() * 2.0;
    piece.angular_velocity = random.direction() * 5.0;
    pieces.push_back(piece);
  }
  return step_world(pile.types, pieces, 90, options);
}

// Two bricks a course, courses crossed; it stands.
SceneResult brick_tower(const SceneOptions& options) {
  std::vector<NewPiece> pieces;
  for (int course = 0; course < 12; ++course) {
    const double yaw = course % 2 == 0 ? 0.0 : 1.5707963;
    const Quat rotation = turned({0, 0, 1}, yaw);
    for (double side : {-0.056, 0.056}) {
      const Vec3 centre = rotation.rotate({0, side, 0}) + Vec3{0, 0, 0.0335 + 0.066 * course};
      pieces.push_back(at(0, centre, rotation));
    }
  }
  return step_world({testing::box_type("brick", 0.215, 0.1025, 0.065)}, pieces, 240, options);
}

// A steel bar of 15 kg under a concrete slab of 1.9 t that lands on it.
SceneResult bar_under_slab(const SceneOptions& options) {
  std::vector<NewPiece> pieces = {at(0, {0, 0, 0.03}, turned({0, 0, 1}, 0.4)),
                                  at(0, {0.5, 0.3, 0.03}, turned({0, 0, 1}, -0.9)),
                                  at(1, {0.1, 0.1, 0.6}, turned({1, 1, 0}, 0.12))};
  return step_world({testing::bar_type(1.5, 0.02), testing::box_type("slab", 2.5, 2, 0.16)}, pieces,
                    240, options);
}

// Chains of slabs, doors and crushed frames among free pieces, one of them hung from a fixed root;
// joints of every kind spring, yield, meet their stops and break.
SceneResult articulated(const SceneOptions& options) {
  PileSpec spec = testing::small_pile(104, 2, 45);
  spec.assemblies = testing::assemblies();
  for (int i = 0; i < int(spec.assemblies.size()); ++i)
    spec.mix.push_back({PieceKind::assembly(i), 3, 0.7, 1.1});
  for (int i = 0; i < int(spec.assemblies.size()); ++i) {
    const Quat rotation = turned({0, 0, 1}, 0.7 * i);
    spec.placed.push_back(at(PieceKind::assembly(i), {-1.5 + 1.5 * i, 0.4, 1.7}, rotation, i != 1).placement);
  }
  return settle(pushed(generate_pile(spec), options.push), Schedule::layers, options);
}

// A frame with brick walls that the ground shakes until its open storey gives way: bonds crack, yield and
// break, bars hold what hangs, the factor of the stresses follows and is made anew.
SceneResult building(const SceneOptions& options) {
  Pile pile;
  BuildingSpec& b = pile.building;
  b.storeys = 2, b.bays_x = 2, b.bays_y = 1;
  b.span_x = 4 + options.push, b.span_y = 4;
  b.column = 0.3, b.beam_depth = 0.35, b.slab = 0.15, b.piece = 1.3;
  b.seed = 105;
  b.cause.shake = 6, b.cause.weak_storey = 0, b.cause.weakness = 0.1;
  pile.types = make_building_types(b);
  return settle(pile, Schedule::layers, options);
}

// Pieces fall on hills of triangles and slide down them.
SceneResult hills(const SceneOptions& options) {
  return step_world(testing::hilly_types(), testing::pieces_on_hills(), 120, options);
}

}  // namespace

const std::vector<Scene>& standard_scenes() {
  static const std::vector<Scene> scenes = {
      {"pile_layers", pile_layers},       {"pile_planes", pile_planes},
      {"pile_midair", pile_midair},       {"brick_tower", brick_tower},
      {"bar_under_slab", bar_under_slab}, {"articulated", articulated},
      {"hills", hills},               {"building", building}};
  return scenes;
}

const Scene& find_scene(const std::string& name) {
  Diagnostic d;
  d.message = "no such scene";
  d.found = name;
  for (const Scene& scene : standard_scenes()) {
    if (scene.name == name) return scene;
    d.expected += (d.expected.empty() ? "" : ", ") + scene.name;
  }
  throw InputError(d);
}

std::string format_result(const std::string& scene, const SceneResult& result) {
  return scene + " " + std::to_string(result.step) + " " + hex64(result.hash);
}

}  // namespace rubble::determinism
