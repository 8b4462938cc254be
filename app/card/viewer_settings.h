// What shows the recordings of a dataset in RViz and Foxglove, with the topics and frames that they have.
#pragma once

#include <map>
#include <string>

#include "scripting/scenario/scenario.h"

namespace rubble {

// Name of a file, relative to the folder of settings, to its text:
//
//   ros1.rviz, ros2.rviz     RViz of ROS 1 and RViz 2: frames, pictures, depth as points, scans
//   foxglove.json            a layout: 3-D view, pictures, inertial unit
std::map<std::string, std::string> make_viewer_settings(const Scenario& scenario);

}  // namespace rubble
