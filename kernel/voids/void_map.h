// The voids of a pile for a robot of a given radius: size, depth and entrances.
//
//   PileState --calc_void_space--> VoidSpace --find_voids--> VoidMap
//
// A robot is a ball. Its centre may be in any void cell with a clearance of at least its radius. Connected cells of
// this kind form one void. Dents that the robot cannot enter by more than its own diameter are left out. Sealed voids
// are included.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/voids/cell_runs.h"
#include "kernel/voids/void_space.h"
#include "kernel/voids/widest_path.h"

namespace rubble {

// An opening of a void to the outside, for a robot.
struct Entrance {
  Vec3 position;      // of the robot's centre at the widest place; unit: m
  Vec3 inward;        // unit length
  double radius = 0;  // of the largest ball that passes there; unit: m
  double area = 0;    // of the opening, for the robot's centre, seen along `inward`; unit: m2
  std::vector<std::uint32_t> openings;  // cells of its centre next to the outside
};

struct Void {
  double volume = 0;         // of the space that the robot can cover; unit: m3
  Vec3 widest;               // centre of the largest ball
  double widest_radius = 0;  // unit: m
  Vec3 deepest;  // place farthest from the entrances along a path of the robot's centre; without
                 // entrances, the place deepest below the envelope
  double path_length = 0;  // from an entrance to `deepest`; 0 without entrances; unit: m
  double depth = 0;  // largest height of the envelope (of solid and void cells) above it; unit: m
  std::vector<Entrance> entrances;   // widest first; empty: sealed for this robot
  double bottleneck_radius = 0;      // of the widest path from outside to `widest`; 0: no path; unit: m
  Vec3 bottleneck;                   // narrowest place of that path
  CellRuns cells;   // covered by the robot
  CellRuns places;  // possible cells of its centre
};

struct RobotVoids {
  double radius = 0;            // of the robot; unit: m
  std::vector<Void> voids;      // largest volume first; equal ones by lowest cell
  double volume = 0;            // of all voids; unit: m3
  double reachable_volume = 0;  // of voids with an entrance; unit: m3
};

// A chamber is a local maximum of the clearance; a throat is the narrowest place between two chambers.
struct Chamber {
  Vec3 position;      // of the largest clearance; unit: m
  double radius = 0;  // unit: m
  double volume = 0;  // of its cells; unit: m3
};
struct Throat {
  int a = 0, b = 0;   // chambers; b = -1: the outside
  Vec3 position;      // of the smallest clearance; unit: m
  double radius = 0;  // unit: m
};
struct VoidGraph {
  std::vector<Chamber> chambers;  // widest first
  std::vector<Throat> throats;    // widest first; one for each pair of chambers
};

struct VoidMap {
  VoidSpace space;                           // the cells of all indices below
  WidestPaths widest;                        // from the outside to every cell of the void
  double void_volume = 0, solid_volume = 0;  // unit: m3
  double covered_volume = 0;                 // VoidSpace::covered_volume; unit: m3
  std::vector<RobotVoids> robots;            // in the order of the requested radii
  VoidGraph graph;                           // for the smallest requested robot
};

// radii: of robots, each at least a voxel (InputError otherwise); unit: m.
VoidMap find_voids(VoidSpace space, const std::vector<double>& radii,
                   const VoidProgress& progress = {});

// Length of the shortest path of the robot's centre from an entrance to each of Void::places, in their order;
// unit: m. Infinite in a sealed void.
std::vector<double> calc_ways_in(const VoidSpace& space, const Void& v);

// The parts of find_voids(). A cell belongs to the void when its clearance is >= radius. Bottlenecks are added later.
RobotVoids find_robot_voids(const VoidSpace& space, double radius, int threads);
// widest: of the same space.
void add_bottlenecks(const VoidSpace& space, const WidestPaths& widest, RobotVoids& robot);
// smallest: smallest clearance of a cell. A chamber must be wider by `persistence` than the throat to the next wider
// chamber; unit: m.
VoidGraph find_graph(const VoidSpace& space, double smallest, double persistence);

}  // namespace rubble
