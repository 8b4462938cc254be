// An inflated tube that grows from its tip by turning inside out (eversion), as the body of a vine
// robot: what a membrane under pressure carries, and what its tip can push with. SI.
//
// Sources: Comer and Levy 1963 (bending of an inflated cylinder: wrinkling and collapse); Blumenschein,
// Okamura and Hawkes 2017 (losses of growth by eversion). Tubes of one wall: pressure alone keeps them in
// shape.
#pragma once

#include <string>

namespace rubble {

inline constexpr int kMostTubeLinks = 254;  // with base and tip, as many as a robot can have

struct EvertingTube {
  double pressure = 10e3;            // above that outside; unit: Pa; range: above 0 to 1e6
  double radius = 0.05;              // unit: m; range: above 0 to 1
  double link_length = 0.05;         // of a link of the model; unit: m; range: above 0 to 1
  double membrane_stiffness = 1e5;   // Young's modulus times the wall's thickness; unit: N/m; > 0
  double membrane_density = 0.14;    // unit: kg/m2; > 0
  // Losses of eversion: pressure that turns the wall inside out at no speed, speed that each pascal above
  // it gives, drag of the inner wall on its way to the tip, friction coefficient of that wall in bends.
  double yield_pressure = 1.5e3;     // unit: Pa; >= 0
  double extensibility = 4e-5;       // unit: m/(s Pa); > 0
  double tail_drag = 0.5;            // unit: N/m; >= 0
  double tail_friction = 0.2;        // unit: 1; >= 0
  // Strain rate times this adds to the strain where the wall is taut (Kelvin-Voigt). unit: s; >= 0
  double damping_time = 0.02;
  int links = 60;       // that can grow: the robot's links 1 to `links`; the one after is the tip
  int start_links = 2;  // that have grown at the start; range: 1 to links

  double area() const;    // of the cross-section; unit: m2
  double length() const;  // when all has grown; unit: m
  // Of wall and of the inner wall, which is as heavy; unit: kg/m
  double mass_per_length() const;
  double bending_stiffness() const;  // E I of the taut tube; unit: N m2
  double wrinkling_moment() const;   // pi P R^3 / 2: from here on a part of the wall is slack; unit: N m
  double collapse_moment() const;    // pi P R^3: no bend carries more; unit: N m
  // What the tip can push with at no speed: P A - Y A - drag L e^(friction * turning), not below 0.
  // length: grown; unit: m. turning: sum of the angles of all bends; unit: rad. Result: N.
  double tip_force(double length, double turning) const;
  // What the force decreases by with speed: A / extensibility; unit: N s/m.
  double speed_loss() const;
};

class RangeCheck;
// key: of the tube, within what `check` collects for.
void check_tube(const EvertingTube& tube, const std::string& key, RangeCheck& check);

}  // namespace rubble
