#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

// UK work size, 215 x 102.5 x 65 mm. wear: widens the rounding and chips of its edges.
Recipe brick(const char* name, double length, double wear, bool broken, std::uint32_t seed) {
  Recipe r;
  r.name = name;
  r.solid.cells = {
      box_cell({-length / 2, -0.05125, -0.0325}, {length / 2, 0.05125, 0.0325}, Surface::brick)};
  if (broken) {
    Face& end = r.solid.cells[0][0];
    end = {normalized(Vec3{1, 0.12, -0.2}), length / 2, Surface::brick_fracture};
  }
  r.solid.wear = {0.005, 0.035, 0.009, 0.0012, 0.004 * wear, 0.012 * wear, 0.035};
  r.solid.seed = seed;
  r.cell = 0.004;
  r.triangles = {broken ? 800 : 640, 160, 24};
  r.max_edge = 0.06;
  r.material = "brick";
  r.weight = broken ? 1 : 2;
  r.tags = {"masonry", "brick"};
  return r;
}

// US size 390 x 190 x 190 mm, cores along Z: shells 32 mm, webs 28 mm.
constexpr double kHalfBlock = 0.095, kShell = 0.032, kWeb = 0.028, kCore = 0.153;

Recipe block_recipe(const char* name, std::uint32_t seed) {
  Recipe r;
  r.name = name;
  r.solid.wear = {0.006, 0.05, 0.011, 0.0014, 0.005, 0.013, 0.045};
  r.solid.seed = seed;
  r.cell = 0.0055;
  r.triangles = {2200, 550, 90};
  r.max_edge = 0.08;
  r.material = "cinder_block";
  r.tags = {"masonry", "block"};
  return r;
}

void add_web(Recipe& r, double min_x) {
  r.parts.push_back(
      box_corners({min_x, -kHalfBlock + kShell, -kHalfBlock}, {min_x + kWeb, kHalfBlock - kShell, kHalfBlock}));
}

void add_core(Recipe& r, double min_x) {
  r.solid.hollows.push_back(box_cell({min_x, -kHalfBlock + kShell, -kHalfBlock - 0.1},
                                     {min_x + kCore, kHalfBlock - kShell, kHalfBlock + 0.1},
                                     Surface::cinder_block));
}

// Shells from the end at `min_x` to the other, which may cut through a core; their collision parts
// end at `part_max_x`, the middle of a rough break.
void add_body(Recipe& r, double min_x, double max_x, double part_max_x) {
  r.solid.cells = {box_cell({min_x, -kHalfBlock, -kHalfBlock}, {max_x, kHalfBlock, kHalfBlock}, Surface::cinder_block)};
  for (const double y : {-kHalfBlock, kHalfBlock - kShell}) {
    r.parts.push_back(box_corners({min_x, y, -kHalfBlock}, {part_max_x, y + kShell, kHalfBlock}));
  }
}

Recipe cinder_block() {
  Recipe r = block_recipe("cinder_block", 201);
  add_body(r, -0.195, 0.195, 0.195);
  for (const double x : {-0.195, -kWeb / 2, 0.195 - kWeb}) add_web(r, x);
  for (const double x : {-0.195 + kWeb, kWeb / 2}) add_core(r, x);
  return r;
}

Recipe half_block() {
  Recipe r = block_recipe("half_cinder_block", 202);
  add_body(r, -kHalfBlock, kHalfBlock, kHalfBlock);
  for (const double x : {-kHalfBlock, kHalfBlock - kWeb}) add_web(r, x);
  r.solid.hollows = {box_cell({-kHalfBlock + kWeb, -kHalfBlock + kShell, -kHalfBlock - 0.1},
                              {kHalfBlock - kWeb, kHalfBlock - kShell, kHalfBlock + 0.1}, Surface::cinder_block)};
  r.triangles = {1400, 350, 60};
  r.weight = 0.7;
  return r;
}

// Broken across its second core: two prongs remain.
Recipe broken_block() {
  Recipe r = block_recipe("broken_cinder_block", 203);
  const double end = 0.085;
  add_body(r, -0.195, end, end - 0.003);
  r.solid.cells[0][0].rough = true;
  for (const double x : {-0.195, -kWeb / 2}) add_web(r, x);
  for (const double x : {-0.195 + kWeb, kWeb / 2}) add_core(r, x);
  r.triangles = {1900, 450, 80};
  return r;
}

}  // namespace

std::vector<Recipe> masonry_pieces() {
  return {brick("brick", 0.215, 1, false, 101),
          brick("worn_brick", 0.213, 1.7, false, 103),
          brick("half_brick", 0.115, 1.2, true, 102),
          cinder_block(),
          half_block(),
          broken_block()};
}

}  // namespace rubble::generator
