// From the links of a URDF file to the bodies that they make: masses, convex parts and looks. For urdf_robot.cpp.
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
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

// What a shape of <collision> is for contacts, in its own frame. Meshes are cut, as those of assets.
// Notes of the importer go to `warnings`. Throws InputError for a mesh that is no solid.
std::vector<ConvexPart> make_urdf_parts(const UrdfGeometry& g, MeshImporter& importer,
                                        std::vector<std::string>& warnings);

// Adds a shape of <visual> to the looks of a link of the model. body_from_link: of the link that the file has it on.
// Notes of the importer go to `warnings`.
void add_urdf_looks(const UrdfGeometry& g, const Pose& body_from_link, RobotModel& model, std::size_t body,
                    MeshImporter& importer, std::vector<std::string>& warnings);

}  // namespace rubble
