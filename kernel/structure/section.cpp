#include "kernel/structure/section.h"

#include <algorithm>
#include <cmath>

namespace rubble {
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

Utilization use_of_bars(const Section& s, const SectionForces& f) {
  Utilization most;
  raise(most, share(std::abs(f.moment_s), calc_yield_moment(s, f.axial, true)) +
                  share(std::abs(f.moment_t), calc_yield_moment(s, f.axial, false)),
        FailureMode::bending);
  if (f.axial > 0) {
    raise(most, f.axial / (s.steel.area * s.steel.yield), FailureMode::tension);
  } else {
    raise(most, -f.axial / squash_load(s), FailureMode::compression);
  }
  return most;
}

double use_of_shear(const Section& s, const SectionForces& f) {
  const double strength = s.shear + s.steel.stirrups +
                          s.shear_friction * std::max(0.0, -f.axial / s.area);
  const double shear = std::sqrt(f.shear_s * f.shear_s + f.shear_t * f.shear_t) / s.area;
  const double twisted = bending_stress(f.torque, std::max(s.half_s, s.half_t),
                                        s.inertia_s + s.inertia_t);
  return strength > 0 ? (shear + twisted) / strength : (shear + twisted > 0 ? 2.0 : 0.0);
}

}  // namespace

const char* failure_name(FailureMode mode) {
  switch (mode) {
    case FailureMode::none: return "none";
    case FailureMode::tension: return "tension";
    case FailureMode::compression: return "compression";
    case FailureMode::shear: return "shear";
    case FailureMode::bending: return "bending";
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

Utilization calc_utilization(const Section& s, const SectionForces& f) {
  Utilization most = use_of_fibres(s, f);
  if (s.steel.area > 0) {
    const Utilization barred = use_of_bars(s, f);
    if (barred.value < most.value) most = barred;
  }
  raise(most, use_of_shear(s, f), FailureMode::shear);
  return most;
}

}  // namespace rubble
