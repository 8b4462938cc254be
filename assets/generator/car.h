// Cars, whole on paper and then crushed. Frame while designed: X forward, Z up, the ground at z = 0,
// the middle of the wheelbase at x = 0.
#pragma once

#include <string>

#include "assets/generator/asset.h"

namespace rubble::generator {

struct CarDamage {
  std::string name;
  double roof = 0;        // how far the roof came down; range: 0 to 0.6; unit: m
  double roof_tilt = 0;   // more of it at the front (> 0) or the rear; range: -1 to 1
  double roof_shift = 0;  // sideways, with the pillars; unit: m
  double front = 0;       // how far the front was pushed back; range: 0 to 0.6; unit: m
  double side = 0;        // how far the left side was pushed in; range: 0 to 0.45; unit: m
  double dents = 0.02;    // depth of the dents all over; unit: m
  int wheels = 4;         // that are still there
  bool windscreen = true;
  bool open = false;  // the left front door and the bonnet are pieces of their own
};

Recipe make_car(const CarDamage& damage);

// Of the same car and bent with it, in its frame: what closes the gaps of an open one.
Recipe make_car_door(const CarDamage& damage);
Recipe make_car_bonnet(const CarDamage& damage);

}  // namespace rubble::generator
