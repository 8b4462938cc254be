// MRPT's CReactiveNavigationSystem3D in lock-step: obstacles and pose of an instant go in, a twist comes out.
//
// The navigator chooses among families of arcs the one that leads towards the goal and clear of obstacles (Blanco,
// Gonzalez and Fernandez-Madrigal 2008, "Extending obstacle avoidance methods through multiple parameter-space
// transformations"). It plans no further than its horizon. The robot is a stack of prisms.
//
// MRPT's clock is one for the process. From the first step() to the end of the last navigator it is that of the
// simulation, so that the same inputs give the same twists; no two navigators may be used at the same time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// A prism of the robot, seen from above a rectangle about the origin of its frame.
struct NavigatorSlice {
  double height = 0.2;                          // unit: m; > 0
  double half_length = 0.4, half_width = 0.3;   // unit: m; > 0
};

struct NavigatorOptions {
  std::vector<NavigatorSlice> slices;  // from the ground up; at least one
  double max_speed = 0.4;              // unit: m/s; > 0
  double max_turn_rate = 0.6;          // unit: rad/s; > 0
  double horizon = 4;                  // obstacles farther away are not looked at; unit: m; > 0
  double goal_radius = 0.3;            // nearer, and the goal is reached; unit: m; > 0
  double give_up_after = 30;           // without coming nearer to the goal; unit: s; > 0
  // A folder for the tables of arcs, which take a second to compute; they are kept for the next navigator.
  std::string cache_folder;
};

// Of an instant. x, y, yaw: in the world.
struct NavigatorInput {
  double time = 0;                                     // since the start; ascending by 0.02 s at least; unit: s
  double x = 0, y = 0, yaw = 0;                        // unit: m, rad
  double velocity_x = 0, velocity_y = 0, turn_rate = 0;  // in the world; unit: m/s, rad/s
  std::vector<Vec3f> obstacles;  // X forward, Y left, Z up from the lowest point of the robot; unit: m
};

enum class NavigatorState { driving, arrived, gave_up };

struct NavigatorOutput {
  NavigatorState state = NavigatorState::driving;
  double linear = 0, angular = 0;  // forwards and to the left; unit: m/s, rad/s
};

class ReactiveNavigator {
 public:
  // Throws InputError for options out of range, RunError when MRPT fails.
  explicit ReactiveNavigator(const NavigatorOptions& options);
  ~ReactiveNavigator();
  ReactiveNavigator(const ReactiveNavigator&) = delete;
  ReactiveNavigator& operator=(const ReactiveNavigator&) = delete;

  // unit: m, in the world. Anew where the navigator had arrived or gave up.
  void set_goal(double x, double y);
  // Throws RunError when MRPT fails.
  NavigatorOutput step(const NavigatorInput& input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
