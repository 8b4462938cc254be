// A building and the cause of its collapse, as data: a frame of reinforced concrete, masonry walls with timber
// floors, precast beams and floor units on columns, a bridge, or a building drawn by a plan.
//
// Lengths in metres, masses in kg, times in s. It stands on the ground z = 0 about the world's Z axis,
// its bays along X and Y; a plan has its own origin. Storeys count from 0 at the ground; column (i, j) is the
// i-th along X and the j-th along Y, from 0 at the lowest x and y; floor k is the slab above storey k. In
// masonry, column (i, j) is the wall about that crossing of grid lines, up to the next openings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// One column of one storey.
struct ColumnPlace {
  int storey = 0, i = 0, j = 0;  // counted as above; all from 0
  std::string part{};            // of a plan: the name of a wall or column; empty: column (i, j)
};

// One bay of every storey.
struct BayPlace {
  int i = 0, j = 0;  // from 0 at the lowest x and y
};

// The footing of one ground column.
struct SinkingFooting {
  int i = 0, j = 0;
  double depth = 0;  // of the settlement; unit: m; range: 0 to 2
  std::string part{};  // as in a ColumnPlace
};

// A vehicle that drives into a column of the ground storey. Its force is that of a hard impact, EN 1991-1-7,
// C.2.1: speed * sqrt(stiffness * mass), for the time sqrt(mass / stiffness).
struct StrikingVehicle {
  double mass = 0;           // unit: kg; range: 0 to 100000; 0: there is none
  double speed = 14;         // unit: m/s; range: 0 to 60
  double direction_deg = 0;  // of travel, from X to Y; unit: degrees
  double stiffness = 300e3;  // unit: N/m; range: 1e4 to 1e7
  double height = 1;         // of its bumper; unit: m; range: 0.2 to 3
  int i = 0, j = 0;          // the column
  std::string part{};        // as in a ColumnPlace
};

// The cause of a collapse.
struct CollapseCause {
  std::vector<ColumnPlace> removed;  // columns that disappear at once
  int weak_storey = -1;              // a storey without walls, with weak columns; -1: none
  double weakness = 1;               // share of the strength of these columns; unit: 1; range: 0 to 1
  int overloaded_floor = -1;         // the floor that carries `overload`; -1: none
  double overload = 0;               // additional load; unit: kg/m2; >= 0
  double shake = 0;                  // largest acceleration of the ground; unit: m/s2; range: 0 to 20
  double shake_hz = 2;               // centre of its frequencies; range: 0.2 to 20
  double shake_seconds = 8;          // range: 1 to 60
  double shake_direction_deg = 0;    // from X to Y; unit: degrees
  // Instead of a synthetic motion: accelerations, scaled so that the largest is `shake`; range: 0 to 200000.
  std::vector<double> accelerogram;
  double accelerogram_step = 0.01;   // between them; unit: s; range: 0.001 to 1
  double blast = 0;                  // impulse per area at 1 m from `blast_at`; unit: N s/m2; >= 0
  Vec3 blast_at;                     // unit: m
  StrikingVehicle vehicle;
  // Their columns go down into the ground with them, at constant speed within 2 s, unless the building holds them up.
  std::vector<SinkingFooting> sinking;

  // Duration of the motion of the ground; unit: s.
  double shaking_time() const {
    if (!(shake > 0)) return 0;
    return accelerogram.empty() ? shake_seconds : double(accelerogram.size()) * accelerogram_step;
  }
};

enum class Infill : std::uint8_t { none, brick, block };
enum class BuildingKind : std::uint8_t { frame, masonry, precast, bridge };

// Walls, windows and beams lie along the line from (x1, y1) to (x2, y2). Slabs, joists and holes fill the
// rectangle between these corners; a column fills the rectangle of its section. Doors are windows that start at 0.
enum class PlanKind : std::uint8_t { wall, column, beam, slab, joists, window, hole };
enum class PlanMaterial : std::uint8_t { concrete, brick, block, timber };

struct PlanPart {
  PlanKind kind = PlanKind::wall;
  std::string name;                // for errors and causes, such as "house.txt:12"
  int lowest = 0, highest = 11;    // storeys that have it
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;  // unit: m
  double thickness = 0.2;          // of walls and slabs, width of beams, depth of joists; unit: m
  double depth = 0.4;              // of beams, below the ceiling; unit: m
  double bottom = 0, top = 0;      // of windows and walls, above the floor; unit: m; top 0: to the ceiling
  PlanMaterial material = PlanMaterial::concrete;
  double bars = -1;                // share of the section; range: 0 to 0.06; below 0: as the frame's
};

// A building drawn by its user. Without parts there is no plan.
struct BuildingPlan {
  std::vector<double> heights;  // of the storeys, floor to floor, from the ground; unit: m; range: 2 to 12
  std::vector<PlanPart> parts;  // in the order of the drawing: where two walls meet, the first one goes through
};

struct BuildingSpec {
  int storeys = 0;                // range: 1 to 12, as many as a plan's heights; 0: there is no building
  int bays_x = 3, bays_y = 3;     // range: 1 to 8
  double span_x = 5, span_y = 5;  // between column axes; unit: m; range: 2 to 12, of bridges to 40
  double storey_height = 3;       // floor to floor; unit: m; range: 2.2 to 6, of bridges to 12
  double column = 0.4;            // edge; unit: m; range: 0.15 to 1.2, of bridges to 2
  double beam_depth = 0.45;       // with the slab; unit: m; range: 0.15 to 1.5, of bridges to 3
  double slab = 0.18;             // thickness; unit: m; range: 0.1 to 0.5
  double column_bars = 0.015;     // share of the section; range: 0 to 0.06
  double beam_bars = 0.012;       // likewise
  double slab_bars = 0.006;       // likewise
  // Share of the bars that hold two pieces together after the concrete between them has failed, until they
  // tear. The other bars are pulled out of their laps and anchorages. 0: broken pieces fall. range: 0 to 1
  double continuity = 0.5;
  Infill infill = Infill::brick;  // walls between the outer columns
  double infill_thickness = 0.2;  // unit: m; range: 0.08 to 0.5
  double openings = 0.35;         // share of windows in the length of each wall, except at corners; range: 0 to 0.8
  double piece = 1.0;             // approximate length of a piece; unit: m; range: 0.3 to 3
  double roughness = 0.35;        // of cuts; range: 0 to 0.45
  BuildingKind kind = BuildingKind::frame;
  Infill partitions = Infill::none;  // of a frame: walls with doors between its inner columns
  double parapet = 0;                // height of walls around the roof; unit: m; range: 0 to 1.5; 0: none
  std::vector<BayPlace> stairs;      // of a frame: flights in these bays, from floor to floor
  std::vector<BayPlace> cores;       // of a frame: lift shafts of reinforced walls in these bays
  double wall = 0.36;                // thickness of load-bearing masonry walls; unit: m; range: 0.15 to 1
  double joist_depth = 0.24, joist_width = 0.14;  // of timber floors; unit: m; range: 0.1 to 0.5, 0.04 to 0.3
  double joist_spacing = 0.8;        // unit: m; range: 0.3 to 2
  BuildingPlan plan;                 // replaces all of these lengths
  std::uint64_t seed = 0;         // of the cuts and of the ground motion
  CollapseCause cause;            // without a cause the building stands

  bool given() const { return storeys > 0 || planned(); }
  bool planned() const { return !plan.parts.empty(); }
  // A frame without optional parts.
  bool plain() const {
    return kind == BuildingKind::frame && !planned() && partitions == Infill::none && !(parapet > 0) &&
           stairs.empty() && cores.empty();
  }
};

}  // namespace rubble
