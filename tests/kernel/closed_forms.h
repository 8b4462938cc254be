// What the closed-form tests share: round pieces, and the answers of mechanics, integrated here on
// their own so that no figure comes from the kernel. SI; Y is the axis of whatever rolls or tips,
// and it does so towards +X.
#pragma once

#include <functional>

#include "kernel/world/world.h"
#include "scenes.h"

namespace rubble::testing {

inline constexpr double kG = 9.81;  // unit: m/s2

WorldOptions awake_options();       // no sleep
WorldOptions weightless_options();  // no sleep, no gravity

// A prism over a regular polygon, its axis along Y, lying on a facet.
PieceType drum_type(double radius, double width, int facets);
double calc_apothem(double radius, int facets);  // from the axis to the middle of a facet

// Distance after rolling from rest down a plane, without slip and without bouncing: the prism turns
// about one edge after the other, and each impact of a new edge keeps the angular momentum about
// it. Valid while speed^2 < g radius; a round drum is the limit, g sin(slope) t^2 / 3.
double calc_prism_rolling(double radius, int facets, double slope, double seconds);
inline double calc_round_rolling(double slope, double seconds) {
  return kG * std::sin(slope) * seconds * seconds / 3;
}

// A rigid body that turns about a fixed edge.
struct Toppling {
  double x = 0, z = 0;          // centre of mass from the edge, at the start; unit: m
  double gyration_squared = 0;  // moment of inertia about the edge over the mass; unit: m2
  double spin = 0;              // at the start; unit: rad/s
  // Until it has turned by `angle`; infinite where it comes back first. unit: s
  double calc_time(double angle) const;
};
// Of a box `width` wide and `height` high about a lower edge, turned by `tilt` towards it.
Toppling topple_box(double width, double height, double tilt);

// How far a piece has turned about Y since it was upright; unit: rad.
double tilt_of(const World& world, int piece);
// Until the tilt passes `angle`, interpolated between steps; infinite after `limit`. unit: s
double measure_tilt_time(World& world, int piece, double angle, double limit);

}  // namespace rubble::testing
