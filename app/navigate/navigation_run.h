// One mission of the navigation benchmark: MRPT's reactive navigator drives the crawler, in lock-step.
//
//   Session (240 Hz) -> scan of the last period, de-skewed -> ObstacleMap -> ReactiveNavigator -> tracks
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/navigate/navigation_world.h"

namespace rubble {

enum class NavigationEnd { arrived, gave_up, time_up, fell, lost };
std::string name_of(NavigationEnd end);

// The robot at the beginning of a period.
struct NavigationStep {
  Vec3 base;       // on its ground, in the world; unit: m
  double yaw = 0;  // unit: rad
  Vec3 target;     // of the navigator; unit: m
};

struct NavigationScore {
  NavigationEnd end = NavigationEnd::time_up;
  bool passes = false;    // the goal was on the other side of the void
  double shortest = 0;    // NavigationWorld::shortest(); unit: m
  double path = 0;        // driven; unit: m
  double inside = 0;      // of that, within the void; unit: m
  double left = 0;        // from the goal at the end, on the ground; unit: m
  double time = 0;        // simulated; unit: s
  int collisions = 0;     // periods in which it began to press against something higher than a step
  int periods = 0;
  int plans = 0, plans_failed = 0;  // of the global planner; of these, that found no way
  std::vector<NavigationStep> way;  // one for each period
  std::uint64_t hash = 0;  // of the motion of all links: equal missions have equal hashes
  // Of this machine, never part of a result:
  int late = 0;               // periods in which map and navigator took longer than a period of the wall's clock
  double slowest = 0;         // of these times; unit: s
};

// seed: of the scanner's noise. cache_folder: as NavigatorOptions. Throws InputError where the robot has no room.
NavigationScore navigate(const NavigationWorld& world, std::uint64_t seed, const std::string& cache_folder);

}  // namespace rubble
