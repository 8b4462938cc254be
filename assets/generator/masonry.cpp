#include "assets/generator/pieces.h"

namespace rubble::generator {
namespace {

Recipe brick(const char* name, double length, bool broken) {
  Recipe r;
  r.name = name;
  r.solid.cells = {box_cell({-length / 2, -0.05125, -0.0325}, {length / 2, 0.05125, 0.0325},
                            Surface::brick)};
  if (broken) r.solid.cells[0][0].surface = Surface::brick_fracture;
  r.solid.wear = {0.008, 0.035, 0.008, 0.0012, 0.004, 0.012, 0.035};
  r.solid.seed = broken ? 102 : 101;
  r.cell = 0.004;
  r.triangles = {broken ? 700 : 600, 160, 24};
  r.max_edge = 0.06;
  r.material = "brick";
  r.weight = 2;
  r.tags = {"masonry", "brick"};
  return r;
}

}  // namespace

std::vector<Recipe> masonry_pieces() {
  return {brick("brick", 0.215, false), brick("half_brick", 0.115, true)};
}

}  // namespace rubble::generator
