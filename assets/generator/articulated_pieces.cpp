#include "assets/generator/pieces.h"

namespace rubble::generator {

// Two slabs that broke apart and hang together by three bars of 12 mm, of which one is drawn. Over
// the 10 cm between the slabs a bar has E I / L = 2e11 Pa * 1.0e-9 m4 / 0.1 m = 2000 N m/rad; it bends
// for good at d^3 / 6 * 500 MPa = 144 N m and tears at 113 mm2 * 550 MPa = 62 kN.
std::vector<ArticulatedRecipe> articulated_concrete() {
  ArticulatedRecipe slab;
  slab.name = "hinged_slab";
  slab.links = {
      R"(name = "near", asset = "slab_3")",
      R"(name = "bar", asset = "rebar_straight", on = "near", joint = "weld",
          position = {0.44, 0, -0.04}, joint_position = {0.36, 0, -0.04}, scale = 0.6)",
      R"(name = "far", asset = "slab_3", on = "bar", joint = "ball",
          position = {0.88, 0, 0}, rpy_deg = {0, 0, 180}, joint_position = {0.48, 0, -0.04},
          stiffness = 6000, damping = 60, yield = 430, break_force = 186000, limit_deg = 110)"};
  slab.scale_min = 0.8, slab.scale_max = 1.2;
  slab.tags = {"concrete", "slab", "articulated"};
  return {slab};
}

}  // namespace rubble::generator
