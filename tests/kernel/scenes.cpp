#include "kernel/world/world_rest.h"
#include "scenes.h"

#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/height_field.h"

namespace rubble::testing {

ConvexPart box_part(double x, double y, double z, const Vec3& centre) {
  ConvexPart part;
  for (double sx : {-0.5, 0.5}) {
    for (double sy : {-0.5, 0.5}) {
      for (double sz : {-0.5, 0.5}) part.points.push_back(centre + Vec3{sx * x, sy * y, sz * z});
    }
  }
  return part;
}

PieceType box_type(const std::string& name, double x, double y, double z) {
  PieceType type;
  type.name = name;
  type.parts = {box_part(x, y, z)};
  type.friction = 0.6;
  return type;
}

PieceType bar_type(double length, double radius) {
  PieceType type;
  type.name = "bar";
  type.density = 7850;
  type.friction = 0.57;
  ConvexPart part;
  for (double x : {-length / 2, length / 2}) {
    for (int k = 0; k < 6; ++k) {
      const auto [s, c] = portable::sincos(portable::kPi / 3 * k);
      part.points.push_back({x, radius * c, radius * s});
    }
  }
  type.parts = {part};
  return type;
}

PieceType chunk_type(const std::string& name, std::uint64_t seed, int points) {
  PieceType type;
  type.name = name;
  RandomStream random(seed, "chunk");
  ConvexPart part;
  for (int i = 0; i < points; ++i) {
    const double radius = random.uniform(0.8, 1.0);  // one draw a statement: C++ fixes no order
    const Vec3 d = random.direction() * radius;
    part.points.push_back({d.x, 0.8 * d.y, 0.55 * d.z});
  }
  type.parts = {part};
  return type;
}

PieceType pipe_type(double length, double inner, double outer, int segments) {
  PieceType type;
  type.name = "pipe";
  for (int k = 0; k < segments; ++k) {
    ConvexPart part;
    for (int side : {k, k + 1}) {
      const auto [s, c] = portable::sincos(2 * portable::kPi * side / segments);
      for (double r : {inner, outer}) {
        for (double x : {-length / 2, length / 2}) part.points.push_back({x, r * c, r * s});
      }
    }
    type.parts.push_back(part);
  }
  return type;
}

PieceType culvert_type() {
  PieceType type;
  type.name = "culvert";
  type.parts = {box_part(2, 1.4, 0.2, {0, 0, -0.6}), box_part(2, 1.4, 0.2, {0, 0, 0.6}),
                box_part(2, 0.2, 1.0, {0, -0.6, 0}), box_part(2, 0.2, 1.0, {0, 0.6, 0})};
  return type;
}

PieceType cinder_block_type() {
  PieceType type;
  type.name = "cinder block";
  type.density = 1900;
  type.friction = 0.65;
  const double l = 0.39, w = 0.19, h = 0.19, t = 0.03;
  type.parts = {box_part(l, t, h, {0, (w - t) / 2, 0}), box_part(l, t, h, {0, -(w - t) / 2, 0})};
  for (double x : {-(l - t) / 2, 0.0, (l - t) / 2}) {
    type.parts.push_back(box_part(t, w - 2 * t, h, {x, 0, 0}));
  }
  return type;
}

PieceType terrain_type(double size, double spacing,
                       const std::function<double(double x, double y)>& height) {
  HeightField field;
  field.columns = field.rows = int(size / spacing + 0.5) + 1;
  field.spacing = spacing;
  field.origin = {-size / 2, -size / 2, 0};
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      field.heights.push_back(
          height(field.origin.x + column * spacing, field.origin.y + row * spacing));
    }
  }
  PieceType type;
  type.name = "terrain";
  type.friction = 0.6;
  type.surface = std::make_shared<const TriangleMesh>(make_height_field_mesh(field, 1, "ground"));
  return type;
}

std::vector<PieceType> hilly_types() {
  std::vector<PieceType> types = rubble_types();
  types.push_back(terrain_type(12, 0.4, [](double x, double y) {
    const double step = x * x > 1.5 ? 0.3 : y * y > 2.5 ? 0.15 : 0.0;
    return 1 + 0.02 * (x * x - y * y) + step;
  }));
  return types;
}

std::vector<NewPiece> pieces_on_hills() {
  std::vector<NewPiece> pieces{at(8, {}, {}, true)};
  for (int i = 0; i < 40; ++i) {
    NewPiece piece = at(i % 8, {-2.0 + 0.6 * (i % 7), -1.8 + 0.7 * (i / 7), 3.2 + 0.4 * (i % 3)},
                        turned({1, double(i % 5) - 2, 2}, 0.7 * i));
    if (i % 8 < 2) piece.placement.scale = 0.3;
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<PieceType> rubble_types() {
  return {chunk_type("chunk a", 1),
          chunk_type("chunk b", 2),
          box_type("slab", 1.2, 0.8, 0.12),
          box_type("block", 0.4, 0.2, 0.2),
          box_type("brick", 0.215, 0.1025, 0.065),
          bar_type(1.5, 0.02),
          pipe_type(1.0, 0.15, 0.2),
          cinder_block_type()};
}

PileSpec small_pile(std::uint64_t seed, int layers, int pieces) {
  PileSpec spec;
  spec.seed = seed;
  spec.types = rubble_types();
  spec.mix = {{0, 3, 0.12, 0.45}, {1, 3, 0.12, 0.45}, {2, 1.5, 0.7, 1.3}, {3, 1.5, 1, 1},
              {4, 1, 1, 1},       {5, 0.5, 0.7, 1.3}, {6, 0.5, 0.8, 1.2}, {7, 1, 1, 1}};
  spec.spawn_bounds = {5, 5, 6};
  spec.spawn_position = {0, 0, 4};
  spec.layers = layers;
  spec.pieces_per_layer = pieces;
  return spec;
}

std::vector<AssemblyType> assemblies() {
  AssemblyType chain;
  chain.name = "slab chain";
  for (int i = 0; i < 4; ++i) chain.links.push_back({2, {{}, {0.85 * i, 0, 0}}, 0.6});
  for (int i = 0; i < 3; ++i) {
    JointType joint;
    joint.parent = i;
    joint.child = i + 1;
    joint.assembly_from_joint.translation = {0.85 * i + 0.425, 0, 0};
    joint.stiffness = 400;
    joint.damping = 30;
    joint.yield = 150;
    joint.upper = 2.5;
    joint.break_force = 2e4;
    chain.joints.push_back(joint);
  }
  AssemblyType frame;
  frame.name = "frame";
  frame.links = {{3, {}, 1}, {2, {{}, {0.85, 0, 0}}, 0.8}, {4, {{}, {-0.35, 0, 0}}, 1},
                 {5, {{}, {0.85, 0.45, 0}}, 0.5}};
  JointType hinge;
  hinge.kind = JointKind::hinge;
  hinge.assembly_from_joint.translation = {0.3, 0, 0};
  hinge.damping = 2;
  hinge.lower = -1.5;
  hinge.upper = 1.5;
  hinge.break_torque = 8000;
  JointType slider;
  slider.child = 2;
  slider.kind = JointKind::slider;
  slider.assembly_from_joint.rotation = turned({0, 0, 1}, portable::kPi);
  slider.stiffness = 300;
  slider.damping = 10;
  slider.lower = 0;
  slider.upper = 0.4;
  JointType weld;
  weld.parent = 1;
  weld.child = 3;
  weld.kind = JointKind::weld;
  weld.assembly_from_joint.translation = {0.85, 0.4, 0};
  weld.break_force = 1500;
  frame.joints = {hinge, slider, weld};
  return {chain, frame};
}

NewPiece at(PieceKind kind, const Vec3& position, const Quat& rotation, bool fixed) {
  NewPiece piece;
  piece.placement.kind = kind;
  piece.placement.world_from_body = {rotation, position};
  piece.placement.fixed = fixed;
  return piece;
}

Quat turned(const Vec3& axis, double angle) {
  const auto [s, c] = portable::sincos(angle / 2);
  const Vec3 n = normalized(axis) * s;
  return {c, n.x, n.y, n.z};
}

bool run_to_rest(World& world, double seconds) {
  const double end = world.time() + seconds;
  while (world.time() < end) {
    world.step();
    if (world.rest().reached(0.05, 0.2)) return true;
  }
  return false;
}

void run(World& world, double seconds) {
  const double end = world.time() + seconds - 1e-9;
  while (world.time() < end) world.step();
}

std::uint64_t hash_of(const World& world) {
  PileState state;
  state.pieces = world.pieces();
  return state.state_hash();
}

}  // namespace rubble::testing
