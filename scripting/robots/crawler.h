// The tracked crawler with flippers. Figures and their sources: docs/reference/robots.md. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

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

inline constexpr double kCrawlerTrackDistance = 0.397;  // unit: m

// Sizes of the parts that collide, which the looks keep to.
struct TrackSize {
  double length = 0;                                    // between the axles; unit: m
  double width = 0, radius_front = 0, radius_rear = 0;  // unit: m
};
// A belt with lugs on wheels, with a plate at the side that looks out (y: 1 or -1). The middle of the belt is
// {0, y, radius}.
TriangleMesh make_track_looks(const TrackSize& size, double y, double side);
// Its hub in the origin, its tip at direction * length along X.
TriangleMesh make_flipper_looks(const TrackSize& size, double direction, double side);
TriangleMesh make_crawler_body_looks();

}  // namespace rubble
