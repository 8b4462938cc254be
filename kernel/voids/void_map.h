// The voids of a pile for a robot of a given radius: how large, how deep, by what entrances.
//
//   PileState --calc_void_space--> VoidSpace --find_voids--> VoidMap
//
// A robot is a ball. Its centre may be in a cell of the void whose clearance is at least its
// radius; such cells that are connected make one void. Dents, which the robot cannot enter by more
// than its own diameter, are left out; sealed voids are not.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/voids/void_space.h"
#include "kernel/voids/widest_path.h"

namespace rubble {

// Where a void for some robot opens to the outside.
struct Entrance {
  Vec3 position;      // of the robot's centre, where it is widest; unit: m
  Vec3 inward;        // unit length
  double radius = 0;  // of the largest ball that passes there; unit: m
  double area = 0;    // of the opening, for the robot's centre, seen along `inward`; unit: m2
  std::vector<std::uint32_t> openings;  // places of its centre from which one step leads outside
};

struct Void {
  double volume = 0;         // what the robot covers in all of its places; unit: m3
  Vec3 widest;               // where the largest ball fits
  double widest_radius = 0;  // unit: m
  Vec3 deepest;  // the place farthest from the entrances along a path of the robot's centre;
                 // where there is no entrance, the place deepest below the envelope
  double path_length = 0;  // from an entrance to `deepest`; 0 without entrances; unit: m
  double depth = 0;  // largest height of the envelope (of solid and void cells) above it; unit: m
  std::vector<Entrance> entrances;   // widest first; empty: sealed for this robot
  double bottleneck_radius = 0;      // of the widest way from outside to `widest`; 0: none; unit: m
  Vec3 bottleneck;                   // where that way is narrowest
  std::vector<std::uint32_t> cells;  // that the robot covers, ascending
  std::vector<std::uint32_t> places;  // of its centre, ascending
};

struct RobotVoids {
  double radius = 0;            // of the robot; unit: m
  std::vector<Void> voids;      // largest volume first; equal ones by lowest cell
  double volume = 0;            // of all of them; unit: m3
  double reachable_volume = 0;  // of those with an entrance; unit: m3
};

// A place where the void is wider than all around, and the narrow places between two of them.
struct Chamber {
  Vec3 position;      // where it is widest; unit: m
  double radius = 0;  // unit: m
  double volume = 0;  // of the cells that belong to it; unit: m3
};
struct Throat {
  int a = 0, b = 0;   // chambers; b = -1: the outside
  Vec3 position;      // where it is narrowest; unit: m
  double radius = 0;  // unit: m
};
struct VoidGraph {
  std::vector<Chamber> chambers;  // widest first
  std::vector<Throat> throats;    // widest first; the widest of each pair of chambers
};

struct VoidMap {
  VoidSpace space;                           // the cells that all indices below count
  WidestPaths widest;                        // from the outside to every cell
  double void_volume = 0, solid_volume = 0;  // unit: m3
  double covered_volume = 0;                 // VoidSpace::covered_volume; unit: m3
  std::vector<RobotVoids> robots;            // in the order of the radii asked for
  VoidGraph graph;                           // for the smallest robot that was asked for
};

// radii: of robots, each at least a voxel (InputError otherwise); unit: m.
VoidMap find_voids(VoidSpace space, const std::vector<double>& radii,
                   const VoidProgress& progress = {});

// The length of the shortest way of the robot's centre from an entrance to each of the void's places, in
// their order; unit: m. Infinite for all of a sealed void.
std::vector<double> calc_ways_in(const VoidSpace& space, const Void& v);

// The parts of find_voids(). A cell belongs to the void when its clearance is >= radius.
RobotVoids find_robot_voids(const VoidSpace& space, const WidestPaths& widest, double radius,
                            int threads);
// smallest: clearance below which cells are left out. A chamber counts when it is wider than the
// throat to the next wider one by `persistence`; unit: m.
VoidGraph find_graph(const VoidSpace& space, double smallest, double persistence);

}  // namespace rubble
