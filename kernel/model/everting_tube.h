// An inflated tube that grows from its tip by turning inside out (eversion): the body of a robot that grows. The
// loads that its membrane carries under pressure, and the force of its tip. SI.
//
// Sources: Comer and Levy 1963 (bending of an inflated cylinder: wrinkling and collapse); Blumenschein,
// Okamura and Hawkes 2017 (losses of growth by eversion). The tube has one wall; pressure alone keeps its
// shape.
#pragma once

#include <string>

namespace rubble {

inline constexpr int kMostTubeLinks = 254;  // with base and tip, as many as a robot can have

struct EvertingTube {
  double pressure = 10e3;            // above ambient; unit: Pa; range: above 0 to 1e6
  double radius = 0.05;              // unit: m; range: above 0 to 1
  double link_length = 0.05;         // of a link of the model; unit: m; range: above 0 to 1
  double membrane_stiffness = 1e5;   // Young's modulus times the wall's thickness; unit: N/m; > 0
  double membrane_density = 0.14;    // unit: kg/m2; > 0
  // Losses of eversion: pressure that everts the wall at zero speed, speed per pascal above it, drag of the
  // inner wall on its way to the tip, friction coefficient of the inner wall in bends.
  double yield_pressure = 1.5e3;     // unit: Pa; >= 0
  double extensibility = 4e-5;       // unit: m/(s Pa); > 0
  double tail_drag = 0.5;            // unit: N/m; >= 0
  double tail_friction = 0.2;        // unit: 1; >= 0
  // Damping of the taut wall (Kelvin-Voigt): strain rate times this time is added to the strain. unit: s; >= 0
  double damping_time = 0.02;
  int links = 60;       // number of links that can grow: 1 to `links` of the robot; the next link is the tip
  int start_links = 2;  // number of links at the start; range: 1 to links

  double area() const;    // of the cross-section; unit: m2
  double length() const;  // of the fully grown tube; unit: m
  // Of outer and inner wall together, which have equal masses; unit: kg/m
  double mass_per_length() const;
  double bending_stiffness() const;  // E I of the taut tube; unit: N m2
  double wrinkling_moment() const;   // pi P R^3 / 2: above it a part of the wall is slack; unit: N m
  double collapse_moment() const;    // pi P R^3: the largest moment of a bend; unit: N m
  // Force of the tip at zero speed: P A - Y A - drag L e^(friction * turning), at least 0. length: grown length;
  // unit: m. turning: sum of the angles of all bends; unit: rad. Result: N.
  double tip_force(double length, double turning) const;
  // Decrease of the force with speed: A / extensibility; unit: N s/m.
  double speed_loss() const;
};

class RangeCheck;
// key: path of the tube in the errors that `check` collects.
void check_tube(const EvertingTube& tube, const std::string& key, RangeCheck& check);

}  // namespace rubble
