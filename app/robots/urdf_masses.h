// Masses and moments of inertia of the bodies that a URDF file's links make.
#pragma once

#include <string>
#include <vector>

#include "io/robot/urdf_reader.h"
#include "kernel/base/error.h"
#include "kernel/model/robot.h"

namespace rubble {

// Where a link of the file is: on which body, and where.
struct UrdfPlace {
  int body = 0;         // index into RobotModel::links
  Pose body_from_link;  // unit: m
};

// Of all links of a body, about their common centre (Steiner). The model has its parts and looks already: a body to
// which the file gives no mass has that of its shape in water, as MuJoCo computes it, and one without moments of
// inertia those of its shape, with a warning. Mistakes have file and line.
// places: by link of the file. lines: of the bodies in the file.
void set_urdf_masses(const UrdfFile& file, const std::vector<UrdfPlace>& places, const std::vector<int>& lines,
                     RobotModel& model, std::vector<std::string>& warnings, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
