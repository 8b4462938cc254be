// A building and what makes it collapse, as data: a frame of reinforced concrete with flat floors and
// walls between its outer columns.
//
// Lengths in metres, masses in kg, times in s. It stands on the ground z = 0 about the world's Z axis,
// its bays along X and Y. Storeys count from 0 at the ground; column (i, j) is the i-th along X and the
// j-th along Y, from 0 at the lowest x and y; floor k is the slab above storey k.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// One column of one storey.
struct ColumnPlace {
  int storey = 0, i = 0, j = 0;  // counted as above; all from 0
};

// The footing of one ground column.
struct SinkingFooting {
  int i = 0, j = 0;
  double depth = 0;  // by which it sinks; unit: m; range: 0 to 2
};

// Drives into a column of the ground storey. Its force is that of a hard impact, EN 1991-1-7, C.2.1:
// speed * sqrt(stiffness * mass), for sqrt(mass / stiffness).
struct StrikingVehicle {
  double mass = 0;           // unit: kg; range: 0 to 100000; 0: there is none
  double speed = 14;         // unit: m/s; range: 0 to 60
  double direction_deg = 0;  // in which it drives, from X to Y; unit: degrees
  double stiffness = 300e3;  // unit: N/m; range: 1e4 to 1e7
  double height = 1;         // of its bumper; unit: m; range: 0.2 to 3
  int i = 0, j = 0;          // the column
};

// What makes the building collapse, and when it is over.
struct CollapseCause {
  std::vector<ColumnPlace> removed;  // columns that are gone at once
  int weak_storey = -1;              // without walls, whose columns have `weakness` of their strength; -1: none
  double weakness = 1;               // unit: 1; range: 0 to 1
  int overloaded_floor = -1;         // that carries `overload` more; -1: none
  double overload = 0;               // unit: kg/m2; >= 0
  double shake = 0;                  // largest acceleration of the ground; unit: m/s2; range: 0 to 20
  double shake_hz = 2;               // about which its frequencies lie; range: 0.2 to 20
  double shake_seconds = 8;          // range: 1 to 60
  double shake_direction_deg = 0;    // from X to Y; unit: degrees
  // Instead of a synthetic motion: accelerations, scaled so that the largest is `shake`; range: 0 to 200000.
  std::vector<double> accelerogram;
  double accelerogram_step = 0.01;   // between them; unit: s; range: 0.001 to 1
  double blast = 0;                  // impulse per area at 1 m from `blast_at`; unit: N s/m2; >= 0
  Vec3 blast_at;                     // unit: m
  StrikingVehicle vehicle;
  std::vector<SinkingFooting> sinking;  // evenly, within 2 s

  // How long the ground of the cause moves; unit: s.
  double shaking_time() const {
    if (!(shake > 0)) return 0;
    return accelerogram.empty() ? shake_seconds : double(accelerogram.size()) * accelerogram_step;
  }
};

enum class Infill : std::uint8_t { none, brick, block };

struct BuildingSpec {
  int storeys = 0;                // range: 1 to 12; 0: there is no building
  int bays_x = 3, bays_y = 3;     // range: 1 to 8
  double span_x = 5, span_y = 5;  // between column axes; unit: m; range: 2 to 12
  double storey_height = 3;       // floor to floor; unit: m; range: 2.2 to 6
  double column = 0.4;            // edge; unit: m; range: 0.15 to 1.2
  double beam_depth = 0.45;       // with the slab; unit: m; range: 0.15 to 1.5
  double slab = 0.18;             // thickness; unit: m; range: 0.1 to 0.5
  double column_bars = 0.015;     // share of the section; range: 0 to 0.06
  double beam_bars = 0.012;       // likewise
  double slab_bars = 0.006;       // likewise
  // Share of the bars that hold two pieces together when the concrete between them has failed, until they
  // tear; the others are pulled out of their laps and anchorages. 0: what breaks falls. range: 0 to 1
  double continuity = 0.5;
  Infill infill = Infill::brick;  // walls between the outer columns
  double infill_thickness = 0.2;  // unit: m; range: 0.08 to 0.5
  double openings = 0.35;         // of the length of each wall but the corners' are windows; range: 0 to 0.8
  double piece = 1.0;             // pieces are about this long; unit: m; range: 0.3 to 3
  double roughness = 0.35;        // of cuts; range: 0 to 0.45
  std::uint64_t seed = 0;         // of cuts and of the ground's motion
  CollapseCause cause;            // without one the building stands

  bool given() const { return storeys > 0; }
};

}  // namespace rubble
