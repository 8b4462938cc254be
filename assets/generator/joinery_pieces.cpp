// Windows and doors.
#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

// The shards that a pane leaves in its frame, along the rim of the opening (x and z, y = 0); none
// hang from above where the head is gone.
void add_shards(Recipe& r, double min_x, double max_x, double min_z, double max_z,
                bool with_head, RandomStream& random) {
  const Vec3 rim[5] = {{min_x, 0, min_z}, {max_x, 0, min_z}, {max_x, 0, max_z}, {min_x, 0, max_z},
                       {min_x, 0, min_z}};
  const Vec3 middle{(min_x + max_x) / 2, 0, (min_z + max_z) / 2};
  for (int side = 0; side < 4; ++side) {
    if (side == 2 && !with_head) continue;
    const double length = distance(rim[side], rim[side + 1]);
    const Vec3 along = (rim[side + 1] - rim[side]) * (1 / length);
    Vec3 in = middle - (rim[side] + rim[side + 1]) * 0.5;
    in = normalized(in - along * dot(in, along));
    for (double at = 0; at < length - 0.06;) {
      const double width = std::fmin(random.uniform(0.07, 0.24), length - at);
      const double tall = random.uniform(0.03, 0.22), lean = random.uniform(-0.04, 0.06);
      const double peak = random.uniform(0.1, 0.7), top = random.uniform(0.012, 0.05);
      const bool gone = random.uniform() < 0.3;
      const Vec3 a = rim[side] + along * at - in * 0.01, b = a + along * width;
      const Vec3 c = a + along * (width * peak + top) + in * (tall * 0.8);
      const Vec3 d = a + along * (width * peak + lean) + in * tall;
      if (!gone) {
        Recipe shard;
        shard.sheets = {quad_sheet(a, b, c, d, 2, 2, 0.004, Surface::glass)};
        shard.triangles = {12, 12, 12};
        shard.collides = false;
        r.attached.push_back(shard);
      }
      at += width * random.uniform(1.0, 1.15);
    }
  }
}

// A casement of two lights about the plane y = 0: stiles, rails and a mullion.
Recipe window(const char* name, bool broken) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "timber", timber_wear(), 0.006);
  const double half_x = 0.6, half_z = 0.5, wide = 0.06, deep = 0.035, lap = 0.004;
  const auto add = [&](const Vec3& low, const Vec3& high) {
    r.solid.cells.push_back(box_cell(low, high, kWood));
  };
  add({-half_x, -deep, -half_z}, {half_x, deep, -half_z + wide});
  if (!broken) add({-half_x, -deep, half_z - wide}, {half_x, deep, half_z});
  add({-half_x, -deep, -half_z + wide - lap}, {-half_x + wide, deep, half_z - wide + lap});
  add({half_x - wide, -deep, -half_z + wide - lap}, {half_x, deep, half_z - wide + lap});
  add({-0.025, -0.025, -half_z + wide - lap}, {0.025, 0.025, half_z - wide + lap});
  if (broken) {  // the head went, and the posts end in splinters
    r.solid.wear.along = {0, 0, 1};
    r.solid.wear.fracture_depth = 0.09;
    for (int i = 1; i < 4; ++i) {
      break_end(r.solid.cells[std::size_t(i)], 2, 1, 0.8, Surface::timber_fracture, random);
    }
    const Vec3 n = normalized(Vec3{1, 0, 0.3});
    r.solid.cells[2].push_back({n, dot(n, {half_x + 0.02, 0, 0.1}), Surface::timber_fracture});
  }
  const double pane_top = broken ? 0.12 : half_z - wide;
  add_shards(r, -half_x + wide, -0.025, -half_z + wide, pane_top, !broken, random);
  add_shards(r, 0.025, half_x - wide, -half_z + wide, broken ? 0.02 : pane_top, !broken,
             random);
  if (!broken) {  // a sill that throws the water off
    r.solid.cells.push_back(extruded_cell(
        0, {{-deep, -half_z - 0.03}, {-deep - 0.06, -half_z - 0.03}, {-deep - 0.06, -half_z - 0.012},
            {-deep + 0.01, -half_z + 0.01}, {-deep + 0.01, -half_z - 0.03}},
        -half_x - 0.04, half_x + 0.04, kWood));
  }
  r.triangles = {3600, 1000, 340};
  r.max_edge = 0.15;
  r.weight = 0.6;
  r.tags = {"timber", "window", "frame"};
  return r;
}

// A lever handle on a plate, drawn only.
Recipe handle(double x, double z, double face, double side) {
  Recipe r;
  r.solid.wear = steel_wear();
  r.solid.wear.edge_round = 0.004;
  const auto span = [&](double a, double b) {  // y from the face outwards
    return side > 0 ? std::array<double, 2>{face + a, face + b}
                    : std::array<double, 2>{-face - b, -face - a};
  };
  const auto plate = span(-0.002, 0.007), neck = span(0, 0.045), grip = span(0.033, 0.049);
  const Surface steel = Surface::steel_galvanised;
  r.solid.cells = {box_cell({x - 0.02, plate[0], z - 0.09}, {x + 0.02, plate[1], z + 0.07}, steel),
                   box_cell({x - 0.009, neck[0], z - 0.009}, {x + 0.009, neck[1], z + 0.009}, steel),
                   box_cell({x - 0.115, grip[0], z - 0.009}, {x + 0.009, grip[1], z + 0.009}, steel)};
  r.cell = 0.004;
  r.triangles = {500, 160, 40};
  r.collides = false;
  return r;
}

// A leaf of 0.86 x 2.0 x 0.04 m, standing in the plane y = 0, with four sunk panels on either side.
Recipe door(const char* name, bool broken) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "timber", timber_wear(), 0.006);
  const double half_x = 0.43, half_z = 1.0, thick = 0.02;
  Cell leaf = box_cell({-half_x, -thick, -half_z}, {half_x, thick, half_z}, kWood);
  r.solid.wear.along = {0, 0, 1};
  if (broken) {
    r.solid.wear.fracture_depth = 0.12;
    leaf.push_back({normalized(Vec3{0.3, 0.1, 1}), 0.42, Surface::timber_fracture});
    leaf.push_back({normalized(Vec3{-0.7, 0, 1}), 0.5, Surface::timber_fracture});
  }
  r.solid.cells = {leaf};
  for (const double side : {1.0, -1.0}) {
    for (const double x : {-0.19, 0.19}) {
      for (const auto& z : {std::array<double, 2>{-0.85, -0.1}, {0.1, 0.85}}) {
        const double floor = thick - 0.008;
        Cell sunk = box_cell({x - 0.13, side > 0 ? floor : -0.1, z[0]},
                             {x + 0.13, side > 0 ? 0.1 : -floor, z[1]}, kWood);
        r.solid.hollows.push_back(sunk);
      }
    }
  }
  if (broken) r.regions = {leaf};
  r.fit_parts = broken;
  const double handle_z = 0.0;
  for (const double side : {1.0, -1.0}) {
    r.attached.push_back(handle(half_x - 0.06, handle_z, thick, side));
  }
  for (const double z : {-0.75, broken ? 0.05 : 0.75}) {  // hinges
    Recipe hinge;
    hinge.solid.wear = steel_wear();
    hinge.solid.cells = {cylinder_cell(2, {-half_x - 0.004, thick, 0}, 0.008, z - 0.05, z + 0.05,
                                       Surface::steel_galvanised)};
    hinge.cell = 0.004;
    hinge.triangles = {160, 80, 24};
    hinge.collides = false;
    r.attached.push_back(hinge);
  }
  r.triangles = {3200, 800, 120};
  r.max_edge = 0.2;
  r.weight = broken ? 0.6 : 0.4;
  r.tags = {"timber", "door"};
  return r;
}

}  // namespace

std::vector<Recipe> joinery_pieces() {
  return {window("window_frame", false), window("window_frame_broken", true), door("door", false),
          door("door_broken", true)};
}

}  // namespace rubble::generator
