// Assets made of others. The figures of the joints follow from what holds them: see each.
#include "assets/generator/car.h"
#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

const CarDamage kOpenCar{"car_open", 0.10, 0.2, 0.02, 0.24, 0.0, 0.02, 4, false, true};

ArticulatedRecipe tree(const char* name, std::vector<std::string> links,
                       std::vector<std::string> tags, double scale_min = 1, double scale_max = 1) {
  tags.push_back("articulated");
  return {name, std::move(links), scale_min, scale_max, 0, std::move(tags)};
}

// Two slabs that broke apart and hang together by three bars of 12 mm, of which one is drawn. Over
// the 10 cm between the slabs a bar has E I / L = 2e11 Pa * 1.0e-9 m4 / 0.1 m = 2000 N m/rad; it bends
// for good at d^3 / 6 * 500 MPa = 144 N m and tears at 113 mm2 * 550 MPa = 62 kN.
ArticulatedRecipe hinged_slab() {
  return tree("hinged_slab",
              {R"(name = "near", asset = "slab_3")",
               R"(name = "bar", asset = "rebar_straight", on = "near", joint = "weld",
          position = {0.44, 0, -0.04}, joint_position = {0.36, 0, -0.04}, scale = 0.6)",
               R"(name = "far", asset = "slab_3", on = "bar", joint = "ball",
          position = {0.88, 0, 0}, rpy_deg = {0, 0, 180}, joint_position = {0.48, 0, -0.04},
          stiffness = 6000, damping = 60, yield = 430, break_force = 186000, limit_deg = 110)"},
              {"concrete", "slab"}, 0.8, 1.2);
}

// Bars of 8 mm that hang out of a slab's edge, each as above: 490 N m/rad over 10 cm, 49 N m, 30 kN.
ArticulatedRecipe slab_hanging_bars() {
  const std::string joint = R"(on = "slab", joint = "ball", scale = 0.7, stiffness = 490, damping = 4,
          yield = 49, break_force = 30000, limit_deg = 100)";
  return tree("slab_hanging_bars",
              {R"(name = "slab", asset = "slab_3")",
               R"(name = "left", asset = "rebar_straight", position = {0.58, 0.16, -0.13},
          rpy_deg = {0, 20, 6}, joint_position = {0.33, 0.14, -0.04}, )" + joint,
               R"(name = "middle", asset = "rebar_straight", position = {0.565, 0, -0.16},
          rpy_deg = {0, 28, 0}, joint_position = {0.33, 0, -0.04}, )" + joint,
               R"(name = "right", asset = "rebar_straight", position = {0.585, -0.17, -0.10},
          rpy_deg = {0, 14, -8}, joint_position = {0.33, -0.14, -0.04}, )" + joint},
              {"concrete", "slab", "rebar"}, 0.8, 1.2);
}

// Bars tied together at one end with soft wire, which bends freely and tears at 1.5 kN.
ArticulatedRecipe rebar_bundle() {
  const std::string tie = R"(asset = "rebar_straight", on = "first", joint = "ball",
          joint_position = {-0.38, 0.01, 0.01}, damping = 0.4, break_force = 1500, limit_deg = 30)";
  return tree("rebar_bundle",
              {R"(name = "first", asset = "rebar_straight")",
               R"(name = "second", position = {0.02, 0.06, 0}, rpy_deg = {0, 0, 4}, )" + tie,
               R"(name = "third", position = {0.03, 0.01, 0.065}, rpy_deg = {0, -5, 1}, )" + tie,
               R"(name = "fourth", position = {-0.02, -0.055, 0.02}, rpy_deg = {0, -1, -4}, )" + tie},
              {"steel", "rebar", "cluster"}, 0.8, 1.3);
}

// Cladding panels one below the other, each on two clips of flat steel, 60 x 6 mm, 6 cm long: together
// 2 E I / L = 7200 N m/rad; they fold at 2 * 250 MPa * b t^2 / 4 = 270 N m, their bolts shear at 60 kN.
ArticulatedRecipe facade_panels() {
  const std::string clips = R"(asset = "facade_panel", joint = "hinge", joint_axis = {1, 0, 0},
          stiffness = 7200, damping = 60, yield = 270, break_force = 60000, limit_deg = 150)";
  return tree("facade_panels",
              {R"(name = "upper", asset = "facade_panel", position = {0, 0, 0.83})",
               R"(name = "middle", on = "upper", joint_position = {0, 0, 0.415}, )" + clips,
               R"(name = "lower", on = "middle", position = {0, 0, -0.83},
          joint_position = {0, 0, -0.415}, )" + clips},
              {"concrete", "facade", "large"});
}

}  // namespace

std::vector<ArticulatedRecipe> articulated_concrete() {
  return {hinged_slab(), slab_hanging_bars(), rebar_bundle(), facade_panels()};
}

// Three hinges, each on six screws that pull out of the jamb at 1 kN.
std::vector<ArticulatedRecipe> articulated_residential() {
  return {tree("door_on_frame",
               {R"(name = "frame", asset = "door_frame")",
                R"(name = "leaf", asset = "door", on = "frame", joint = "hinge",
          joint_position = {-0.434, 0.02, 0}, damping = 8, break_force = 18000,
          limit_deg = {0, 110})"},
               {"timber", "door", "large"})};
}

// The door stands ajar by 25 degrees and the bonnet by 20. A door's check strap holds about 12 N m.
std::vector<ArticulatedRecipe> articulated_parking() {
  return {tree("car_with_door",
               {R"(name = "car", asset = "car_open")",
                R"(name = "door", asset = "car_door", on = "car", joint = "hinge",
          position = {-0.281, 0.4126, 0}, rpy_deg = {0, 0, -25}, joint_position = {0.79, 0.84, 0},
          stiffness = 60, damping = 8, yield = 12, break_force = 9000, limit_deg = {-45, 24})",
                R"(name = "bonnet", asset = "car_bonnet", on = "car", joint = "hinge",
          position = {0.170, 0, -0.306}, rpy_deg = {0, -20, 0}, joint_position = {0.952, 0, 0.33},
          joint_axis = {0, 1, 0}, stiffness = 120, damping = 12, yield = 20, break_force = 6000,
          limit_deg = {-50, 19})"},
               {"vehicle", "car", "large"})};
}

// Of precast concrete, 1.2 x 0.07 x 0.8 m in the plane y = 0, one corner broken off.
std::vector<Recipe> facade_pieces() {
  RandomStream random = piece_stream("facade_panel");
  Recipe r = concrete_recipe("facade_panel", random);
  Cell panel = box_cell({-0.6, -0.035, -0.4}, {0.6, 0.035, 0.4}, Surface::concrete_cast);
  const Vec3 n = normalized(Vec3{1, 0.2, -1.3});
  panel.push_back({n, dot(n, {0.5, 0, -0.33}), Surface::concrete_fracture});
  r.solid.cells = {panel};
  r.solid.wear.edge_round = 0.008, r.solid.wear.edge_chip = 0.014;
  r.cell = 0.010;
  r.triangles = {3200, 800, 80};
  r.weight = 0;
  r.tags = {"concrete", "facade"};
  return {r};
}

// Around the leaf of `door`, with a gap of 15 mm.
std::vector<Recipe> door_frames() {
  RandomStream random = piece_stream("door_frame");
  Recipe r = plain_recipe("door_frame", random, "timber", timber_wear(), 0.008);
  r.solid.wear.along = {0, 0, 1};
  const Surface wood = Surface::timber;
  r.solid.cells = {box_cell({-0.495, -0.05, -1.0}, {-0.445, 0.05, 1.02}, wood),
                   box_cell({0.445, -0.05, -1.0}, {0.495, 0.05, 1.02}, wood),
                   box_cell({-0.495, -0.05, 1.016}, {0.495, 0.05, 1.066}, wood)};
  r.triangles = {3000, 800, 160};
  r.max_edge = 0.2;
  r.weight = 0;
  r.tags = {"timber", "door", "frame"};
  return {r};
}

std::vector<Recipe> open_cars() {
  return {make_car(kOpenCar), make_car_door(kOpenCar), make_car_bonnet(kOpenCar)};
}

}  // namespace rubble::generator
