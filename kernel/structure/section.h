// Capacity of a cross-section: strengths of its material and bars against its forces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/structure/polygon.h"

namespace rubble {

// Materials of members: the strengths at which a section fails.
//
// Strengths are mean values, not design values: a simulation needs the load at which a real section breaks. Each bundled
// figure has its source in section.cpp.
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

// Bars that cross a section, the same on opposite sides.
struct SectionSteel {
  double area = 0;          // of all bars; unit: m2; 0: none
  double area_s = 0;        // of those on one side, in tension when it bends about s; unit: m2
  double area_t = 0;        // the same about t; unit: m2
  double cover = 0.04;      // from the surface to the bars' axes; unit: m
  double stirrups = 0;      // what stirrups add to the shear strength; unit: Pa
  double yield = 0;         // unit: Pa
  double rupture_rotation = 0;  // plastic, at which a hinge tears; unit: rad
};

struct Section {
  Vec3 normal, axis_s, axis_t;  // unit length; from the bond's first piece to its second
  Vec3 centroid;                // unit: m
  double area = 0;              // unit: m2
  double inertia_s = 0, inertia_t = 0;  // unit: m4
  double half_s = 0, half_t = 0;        // unit: m
  double torsion_constant = 0;          // of St. Venant; unit: m4
  double torsion_modulus = 0;           // torque over the largest shear stress; unit: m3
  double compression = 0, tension = 0, shear = 0, shear_friction = 0;  // unit: Pa; the last 1
  SectionSteel steel;  // bars through the section; none in masonry
};

// In a section, by what the second piece does to the first: tension is positive.
struct SectionForces {
  double axial = 0;                   // unit: N
  double shear_s = 0, shear_t = 0;    // unit: N
  double torque = 0;                  // about the normal; unit: N m
  double moment_s = 0, moment_t = 0;  // unit: N m
};

enum class FailureMode : std::uint8_t { none, tension, compression, shear, bending, torsion };
const char* failure_name(FailureMode mode);

// The largest share of a strength that is used up; above 1 the section fails, by `mode`.
struct Utilization {
  double value = 0;                      // unit: 1
  FailureMode mode = FailureMode::none;  // of that strength
};

Section make_section(const Polygon& polygon, const Vec3& normal, const StructuralMaterial& material,
                     const SectionSteel& steel);

// Without bars: the extreme fibres by N/A + M c/I against tension and compression. With bars: the larger
// of that and of what the bars carry once the concrete is cracked, by a rectangular stress block of
// 0.85 fc and bars that yield on the tension side, both axes and torsion added linearly. Shear as V/A, and
// in uncracked concrete torsion as T/W on top, against shear strength, stirrups and friction.
Utilization calc_utilization(const Section& section, const SectionForces& forces);

// The moment that bars carry about an axis under this axial force; 0 without bars. about_s: about s,
// otherwise about t. unit: N m.
double calc_yield_moment(const Section& section, double axial, bool about_s);

// The torque that bars and stirrups carry as a thin-walled tube; 0 without either. EN 1992-1-1, 6.3.2, with
// the angle at which both yield: T = 2 Ak sqrt(ql qt), where ql and qt are the forces of bars and stirrups
// per length of the tube's wall. unit: N m
double calc_yield_torque(const Section& section);

}  // namespace rubble
