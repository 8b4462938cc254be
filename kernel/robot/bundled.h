// The bundled robots. Figures and their sources: docs/reference/robots.md. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// A chain of equal modules with hinges about Z and Y in turn, as the CMU unified snake. Link 0 is the head,
// X forwards. Joint i connects link i + 1 behind link i. Origin: the middle of the head.
struct SnakeOptions {
  int modules = 16;          // range: 2 to 64
  double diameter = 0.052;   // unit: m; range: 0.01 to 1
  double length = 0.0585;    // of a module; unit: m; range: 0.01 to 1
  double module_mass = 0.2;  // unit: kg; range: 0.001 to 100
  double effort = 7;         // unit: N m; range: 0.01 to 1000
  double speed = 3;          // unit: rad/s; range: 0.1 to 30
  double friction = 0.5;     // range: 0 to 2
};
RobotModel make_snake(const SnakeOptions& options = {});

// Two tracks with moving contact surfaces and four flippers with belts of their own, as the tracked robot
// Absolem. Origin: on the ground between the tracks. Joints: front left, front right, rear left, rear
// right flipper; 0: stretched out level, positive: raised.
struct CrawlerOptions {
  bool flippers = true;
  double friction = 0.7;      // range: 0 to 2
  double speed = 0.6;         // of the belts at most; unit: m/s; range: 0.01 to 5
  double flipper_start = 1.0; // initial angle of the flippers; unit: rad; range: -3.1 to 3.1
};
RobotModel make_crawler(const CrawlerOptions& options = {});

// Four driven wheels, steered by skidding. Origin: on the ground between the wheels. Joints: front left,
// front right, rear left, rear right wheel; positive drives forwards.
struct RoverOptions {
  double friction = 0.8;  // range: 0 to 2
  double speed = 1.0;     // unit: m/s; range: 0.01 to 5
};
RobotModel make_rover(const RoverOptions& options = {});

// An inflated tube that grows from its tip. Origin: the middle of the mouth of the base, X forwards. The base is
// a box behind it that is staked to the ground. Link i + 1 is the i-th link of the tube; joint i bends it about Y
// (i even) or Z (i odd). The last link is the tip, on the joint `growth`.
struct VineOptions {
  EvertingTube tube;      // with the largest number of links
  double tip_mass = 0.12; // of the mount with camera and lamp; unit: kg; range: 0.001 to 10
  double friction = 0.4;  // range: 0 to 2
  double speed = 0.3;     // of growth at most; unit: m/s; range: 0.001 to 1
};
RobotModel make_vine(const VineOptions& options = {});
// Number of links for a length; unit: m
int count_vine_links(double length, double link_length);

// Dimensions that convert twists to speeds of tracks and wheels.
inline constexpr double kCrawlerTrackDistance = 0.397;  // unit: m
inline constexpr double kRoverTrackDistance = 0.376;    // unit: m
inline constexpr double kRoverWheelRadius = 0.098;      // unit: m

}  // namespace rubble
