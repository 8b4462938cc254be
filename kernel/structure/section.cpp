#include "kernel/structure/section.h"

#include <algorithm>
#include <cmath>

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

namespace {

constexpr double kStressBlock = 0.85;  // of the strength, in the rectangle at failure: ACI 318, 22.2.2.4

void raise(Utilization& most, double value, FailureMode mode) {
  if (value > most.value) most = {value, mode};
}

double bending_stress(double moment, double reach, double inertia) {
  return inertia > 0 ? std::abs(moment) * reach / inertia : 0;
}

// What a section of brittle material uses up. Where it has no tensile strength at all, any tension is
// too much.
Utilization use_of_fibres(const Section& s, const SectionForces& f) {
  const double axial = f.axial / s.area;
  const double bent = bending_stress(f.moment_s, s.half_t, s.inertia_s) +
                      bending_stress(f.moment_t, s.half_s, s.inertia_t);
  Utilization most;
  const double pulled = axial + bent, pressed = bent - axial;
  if (pulled > 0) {
    raise(most, s.tension > 0 ? pulled / s.tension : 2.0,
          bent > axial ? FailureMode::bending : FailureMode::tension);
  }
  if (pressed > 0) raise(most, pressed / s.compression, FailureMode::compression);
  return most;
}

double squash_load(const Section& s) {
  return kStressBlock * s.compression * (s.area - s.steel.area) + s.steel.area * s.steel.yield;
}

double share(double used, double capacity) {
  return capacity > 0 ? used / capacity : (used > 0 ? 1e9 : 0.0);
}

// Concrete that is cracked, and bars that yield: in bending, in torsion, by the axial force.
Utilization use_of_bars(const Section& s, const SectionForces& f) {
  Utilization most;
  const double bent = share(std::abs(f.moment_s), calc_yield_moment(s, f.axial, true)) +
                      share(std::abs(f.moment_t), calc_yield_moment(s, f.axial, false));
  const double torque = calc_yield_torque(s), twisted = torque > 0 ? std::abs(f.torque) / torque : 0;
  raise(most, bent + twisted, twisted > bent ? FailureMode::torsion : FailureMode::bending);
  if (f.axial > 0) {
    raise(most, f.axial / (s.steel.area * s.steel.yield), FailureMode::tension);
  } else {
    raise(most, -f.axial / squash_load(s), FailureMode::compression);
  }
  return most;
}

// torque: what uncracked concrete carries of it.
double use_of_shear(const Section& s, const SectionForces& f, double torque) {
  const double strength = s.shear + s.steel.stirrups +
                          s.shear_friction * std::max(0.0, -f.axial / s.area);
  const double shear = std::sqrt(f.shear_s * f.shear_s + f.shear_t * f.shear_t) / s.area;
  const double stress = shear + std::abs(torque) / s.torsion_modulus;
  return strength > 0 ? stress / strength : (stress > 0 ? 2.0 : 0.0);
}

// Of a rectangle with the same area and longer side: Roark's Formulas for Stress and Strain, table 10.1.
void set_torsion(Section& s) {
  const double extent = 2 * std::max(s.half_s, s.half_t);
  const double one = s.area / extent, a = std::max(one, extent), b = std::min(one, extent);
  const double slim = b / a, second = slim * slim, fourth = second * second;
  s.torsion_constant = a * b * b * b * (1.0 / 3 - 0.21 * slim * (1 - fourth / 12));
  s.torsion_modulus =
      a * b * b / (3 * (1 + 0.6095 * slim + 0.8865 * second - 1.8023 * second * slim + 0.91 * fourth));
}

}  // namespace

const char* failure_name(FailureMode mode) {
  switch (mode) {
    case FailureMode::none: return "none";
    case FailureMode::tension: return "tension";
    case FailureMode::compression: return "compression";
    case FailureMode::shear: return "shear";
    case FailureMode::bending: return "bending";
    case FailureMode::torsion: return "torsion";
  }
  return "none";
}

Section make_section(const Polygon& polygon, const Vec3& normal, const StructuralMaterial& material,
                     const SectionSteel& steel) {
  const PlaneAxes axes = make_axes(normal);
  const AreaProperties area = calc_area_properties(polygon, axes);
  Section section;
  section.normal = normal;
  section.axis_s = axes.s, section.axis_t = axes.t;
  section.centroid = area.centroid;
  section.area = area.area;
  section.inertia_s = area.inertia_s, section.inertia_t = area.inertia_t;
  section.half_s = area.half_s, section.half_t = area.half_t;
  section.compression = material.compression, section.tension = material.tension;
  section.shear = material.shear, section.shear_friction = material.shear_friction;
  section.steel = steel;
  set_torsion(section);
  return section;
}

double calc_yield_moment(const Section& s, double axial, bool about_s) {
  const double steel = about_s ? s.steel.area_s : s.steel.area_t;
  if (!(s.steel.area > 0) || !(steel > 0)) return 0;
  const double height = 2 * (about_s ? s.half_t : s.half_s);
  const double lever = height - 2 * s.steel.cover;
  if (!(lever > 0)) return 0;
  const double bars = steel * s.steel.yield * lever;
  if (axial >= 0) return bars * std::max(0.0, 1 - axial / (s.steel.area * s.steel.yield));
  // The block that carries the axial force moves it to the pressed side; where the block is the whole
  // section, only what the bars leave remains.
  const double block = std::min(1.0, -axial / (kStressBlock * s.compression * s.area));
  const double left = std::clamp((squash_load(s) + axial) / (s.steel.area * s.steel.yield), 0.0, 1.0);
  return left * bars - axial * height * (1 - block) / 2;
}

double calc_yield_torque(const Section& s) {
  const double width = 2 * std::max(s.half_s, s.half_t) - 2 * s.steel.cover;
  const double depth = 2 * std::min(s.half_s, s.half_t), wall = depth - 2 * s.steel.cover;
  if (!(width > 0 && wall > 0)) return 0;
  const double along = s.steel.area * s.steel.yield / (2 * (width + wall));
  const double around = s.steel.stirrups * depth / 2;  // of one of two legs
  return 2 * width * wall * std::sqrt(along * around);
}

Utilization calc_utilization(const Section& s, const SectionForces& f) {
  Utilization plain = use_of_fibres(s, f);
  raise(plain, use_of_shear(s, f, f.torque), FailureMode::shear);
  if (!(s.steel.area > 0)) return plain;
  Utilization barred = use_of_bars(s, f);
  // Without stirrups only the concrete carries torsion.
  raise(barred, use_of_shear(s, f, calc_yield_torque(s) > 0 ? 0 : f.torque), FailureMode::shear);
  return barred.value < plain.value ? barred : plain;
}

}  // namespace rubble
