// Materials of members: the strengths at which a section fails.
//
// Strengths are mean values, not design values: a simulation needs the load at which a real section breaks. Each bundled
// figure has its source in material.cpp.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct StructuralMaterial {
  std::string name;           // as scripts write it: "concrete"
  double density = 2400;      // unit: kg/m3; range: 10 to 20000
  double friction = 0.8;      // Coulomb, of loose pieces against concrete; range: 0 to 2
  double youngs_modulus = 0;  // unit: Pa; > 0
  double poisson_ratio = 0;   // unit: 1; range: 0 to 0.5
  double compression = 0;     // strength; unit: Pa; > 0
  double tension = 0;         // direct and in bending; unit: Pa; >= 0
  double shear = 0;           // without normal stress; unit: Pa; >= 0
  double shear_friction = 0;  // what a compressive stress adds to it; unit: 1; range: 0 to 2
  std::string source;         // where the figures are published
};

// Bars of a reinforced section.
struct Steel {
  double yield = 550e6;           // mean of grade B500; unit: Pa; > 0
  double rupture_rotation = 0.035;  // plastic rotation at which the bars of a hinge tear; unit: rad; > 0
};

// concrete, brick_masonry, block_masonry, timber. Throws InputError naming `key` and listing the names
// when there is no such material.
const StructuralMaterial& find_structural_material(const std::string& name, const std::string& key);
const std::vector<StructuralMaterial>& structural_materials();

}  // namespace rubble
