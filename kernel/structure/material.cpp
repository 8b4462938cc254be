#include "kernel/structure/material.h"

#include "kernel/base/error.h"

namespace rubble {

const std::vector<StructuralMaterial>& structural_materials() {
  static const std::vector<StructuralMaterial> all{
      // C25/30 of EN 1992-1-1, table 3.1: fcm 33 MPa, fctm 2.6 MPa, Ecm 31 GPa. Shear without
      // stirrups by ACI 318-19, 22.5.5: 0.17 sqrt(fc) MPa; 0.15 of the axial stress is k1 of EN
      // 1992-1-1, 6.2.2.
      {"concrete", 2400, 0.8, 31e9, 0.2, 33e6, 2.6e6, 0.98e6, 0.15,
       "EN 1992-1-1 table 3.1 and 6.2.2; ACI 318-19 22.5.5"},
      // Clay brick of 15 MPa in mortar M5, group 1: fk = 0.55 fb^0.7 fm^0.3 = 5.9 MPa, E = 1000 fk
      // (3.7.2), initial shear 0.2 MPa and friction 0.4 (3.6.2, table 3.4), flexure along the bed
      // joints 0.1 MPa (3.6.4).
      {"brick_masonry", 1900, 0.65, 5.9e9, 0.2, 5.9e6, 0.1e6, 0.2e6, 0.4,
       "EN 1996-1-1 3.6.1, 3.6.2, 3.6.4, 3.7.2"},
      // Hollow concrete block of 5 MPa in M5, group 2: fk = 0.45 fb^0.7 fm^0.3 = 2.2 MPa. The density is
      // that of the wall, its cells included.
      {"block_masonry", 1200, 0.65, 2.2e9, 0.2, 2.2e6, 0.05e6, 0.15e6, 0.4,
       "EN 1996-1-1 3.6.1, 3.6.2, 3.6.4, 3.7.2"},
      // Strength class C24: mean density 420, mean E 11 GPa, bending 24, tension 14, compression 21,
      // shear 4 MPa; along the grain. Members of timber bend, and bending fails by the tension side: tension is
      // that of bending, and compression is above it.
      {"timber", 420, 0.5, 11e9, 0.3, 26e6, 24e6, 4e6, 0, "EN 338 table 1"},
  };
  return all;
}

const StructuralMaterial& find_structural_material(const std::string& name, const std::string& key) {
  std::string names;
  for (const StructuralMaterial& material : structural_materials()) {
    if (material.name == name) return material;
    names += (names.empty() ? "" : ", ") + material.name;
  }
  throw InputError({"", 0, key, "no such structural material", names, name, ""});
}

}  // namespace rubble
