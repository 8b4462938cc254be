// Views along a planned way that goes straight up or down: the yaw of such a view means nothing, and a camera that looks at the
// next point of the way would turn over between two waypoints.
#pragma once

#include <vector>

#include "scripting/trajectory/trajectory.h"

namespace rubble {

// Gives waypoints whose view is within 12 degrees of the vertical, or passes there on the way to the next one, or turns by more than
// 60 degrees until there, an orientation instead of a look_at. So the camera turns evenly, and through a vertical part of the way from
// the yaw before it to the yaw after it. ahead: of each waypoint, whether it looks ahead because nobody asked for another view; others
// stay as they are.
void turn_steep_views(const std::vector<bool>& ahead, std::vector<Waypoint>& waypoints);

}  // namespace rubble
