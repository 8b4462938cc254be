// Visual meshes of the bundled robots.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// The link's looks, or where it has none its collision parts in that surface's name.
TriangleMesh make_link_mesh(const RobotLink& link, const std::string& surface);
// Surfaces of the bundled robots: rubber where a belt runs and on wheels, paint or metal elsewhere.
std::string choose_link_surface(const RobotModel& model, std::size_t link);

}  // namespace rubble
