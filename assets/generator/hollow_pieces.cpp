#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr double kBore = 0.30, kOuter = 0.36;  // radii of the pipe; unit: m

// A flat face across an arc of `step` radians stands off it by at most half the sagitta when its
// ends lie this much farther out than the arc.
double chord_factor(double step) {
  const double cosine = portable::cos(step / 2);
  return 2 / (1 + cosine);
}

// Convex pieces of a ring about X from angle `from` in `count` steps.
void add_ring_parts(Recipe& r, double min_x, double max_x, double from, double step, int count) {
  const double grow = chord_factor(step);
  for (int i = 0; i < count; ++i) {
    std::vector<Vec3> part;
    for (int k = 0; k < 2; ++k) {
      const portable::SinCos turn = portable::sincos(from + step * (i + k));
      for (const double radius : {kBore * grow, kOuter * grow}) {
        for (const double x : {min_x, max_x}) {
          part.push_back({x, radius * turn.cos, radius * turn.sin});
        }
      }
    }
    r.parts.push_back(part);
  }
}

// A length of pipe about X; the bounding planes stand clear of the round faces.
Recipe pipe_recipe(const char* name, double length) {
  RandomStream random = piece_stream(name);
  Recipe r = concrete_recipe(name, random);
  const double clear = kOuter + 0.08, half = length / 2;
  Cell body = box_cell({-half, -clear, -clear}, {half, clear, clear}, kCast);
  body.push_back({{1, 0, 0}, kOuter, kCast, true});
  r.solid.cells = {body};
  Cell bore = box_cell({-length, -clear, -clear}, {length, clear, clear}, kCast);
  bore.push_back({{1, 0, 0}, kBore, kCast, true});
  r.solid.hollows = {bore};
  r.solid.wear.edge_round = 0.010;
  r.solid.wear.edge_chip = 0.02;
  r.cell = 0.014;
  r.max_edge = 0.12;
  r.tags = {"concrete", "pipe"};
  return r;
}

Recipe pipe() {
  Recipe r = pipe_recipe("pipe", 1.2);
  r.solid.cells[0][0].surface = kBroken;
  const int segments = 18;
  add_ring_parts(r, -0.6, 0.595, 0, 2 * portable::kPi / segments, segments);
  r.triangles = {4200, 1000, 160};
  r.scale_min = 0.8, r.scale_max = 1.2;
  r.weight = 0.15;
  r.tags.push_back("void");
  return r;
}

// A third of a pipe's round, broken on all sides but one.
Recipe pipe_shard() {
  Recipe r = pipe_recipe("pipe_shard", 0.7);
  Cell& body = r.solid.cells[0];
  body[0].surface = kBroken;
  const double half_angle = 55 * portable::kPi / 180;
  const portable::SinCos turn = portable::sincos(half_angle);
  for (const double side : {1.0, -1.0}) {
    body.push_back({{0, side * turn.cos, -turn.sin}, 0, kBroken});
  }
  const int segments = 6;
  // The parts end in the middle of the rough breaks: 5 mm short, 0.014 rad at the sides.
  const double reach = half_angle - 0.014;
  add_ring_parts(r, -0.35, 0.345, portable::kPi / 2 - reach, 2 * reach / segments, segments);
  r.triangles = {2400, 600, 80};
  r.cell = 0.012;
  r.scale_min = 0.7, r.scale_max = 1.2;
  r.weight = 0.4;
  return r;
}

// 2 m of a box culvert along X: bore 1.2 x 1.2 m with 0.1 m haunches, walls 0.15 m.
Recipe box_culvert() {
  RandomStream random = piece_stream("box_culvert");
  Recipe r = concrete_recipe("box_culvert", random);
  const double in = 0.6, out = 0.75, half = 1.0, haunch = 0.1;
  r.solid.cells = {box_cell({-half, -out, -out}, {half, out, out}, kCast)};
  Cell bore = box_cell({-half - 0.2, -in, -in}, {half + 0.2, in, in}, kCast);
  const double s = portable::cos(portable::kPi / 4);
  for (const double y : {1.0, -1.0}) {
    for (const double z : {1.0, -1.0}) {
      bore.push_back({{0, y * s, z * s}, (2 * in - haunch) * s, kCast});
      std::vector<Vec3> wedge;
      for (const double x : {-half, half}) {
        wedge.push_back({x, y * in, z * in});
        wedge.push_back({x, y * (in - haunch), z * in});
        wedge.push_back({x, y * in, z * (in - haunch)});
      }
      r.parts.push_back(wedge);
    }
    r.parts.push_back(
        box_corners({-half, y > 0 ? in : -out, -out}, {half, y > 0 ? out : -in, out}));
    r.parts.push_back(box_corners({-half, -in, y > 0 ? in : -out}, {half, in, y > 0 ? out : -in}));
  }
  r.solid.hollows = {bore};
  r.solid.wear.edge_chip = 0.045, r.solid.wear.chip_size = 0.13;
  r.cell = 0.02;
  r.triangles = {5000, 1200, 150};
  r.max_edge = 0.2;
  r.weight = 0.05;
  r.tags = {"concrete", "culvert", "void", "large"};
  return r;
}

}  // namespace

std::vector<Recipe> hollow_pieces() { return {pipe(), pipe_shard(), box_culvert()}; }

}  // namespace rubble::generator
