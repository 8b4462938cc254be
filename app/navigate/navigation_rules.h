// The rules of the navigation benchmark, version 1: the robot, what it senses, how long it has, what counts.
// docs/explanation/autonomy.md states them for people.
#pragma once

namespace rubble {

struct NavigationRules {
  double radius = 0.42;        // of the ball that must pass the void; the crawler is 0.63 m wide; unit: m
  double period = 0.2;         // of the navigator, and of a scan; unit: s
  double time_limit = 120;     // simulated; unit: s
  double goal_radius = 0.3;    // of the base from the goal: it has arrived; unit: m
  double speed = 0.3;          // at most; unit: m/s
  double turn_rate = 0.6;      // at most; unit: rad/s
  double horizon = 4;          // of the navigator; unit: m
  double step_height = 0.1;    // what is lower is driven over; unit: m
  double height = 0.5;         // of the robot; unit: m
  bool plans = false;          // a global planner over the robot's own map gives the navigator places to drive to
  double plan_radius = 0.36;   // of the disc that it plans for; unit: m
  double other_way_after = 6;    // with a planner: so long there, and it plans another way; unit: s
  double stuck_time = 30;      // with a planner: within stuck_distance for so long, and it gives up; unit: s
  double stuck_distance = 0.5;   // unit: m
  double waypoint_radius = 0.6;  // of the base from a waypoint: the next one is driven to; unit: m
  double scanner_height = 0.35;  // above the ground under the robot; unit: m
  double voxel = 0.05;         // of the robot's map; unit: m
  int hits = 2;                // echoes that make a cell of the map occupied
};

}  // namespace rubble
