// The shapes of a URDF file as convex parts and as looks of the bodies that carry them.
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "io/robot/urdf_reader.h"
#include "kernel/model/robot.h"

namespace rubble {

// What a shape of <collision> is for contacts, in its own frame. Meshes are cut, as those of assets.
// Notes of the importer go to `warnings`. Throws InputError for a mesh that is no solid.
std::vector<ConvexPart> make_urdf_parts(const UrdfGeometry& g, MeshImporter& importer,
                                        std::vector<std::string>& warnings);

// Adds a shape of <visual> to the looks of a link of the model. body_from_link: of the link that the file has it on.
// Notes of the importer go to `warnings`.
void add_urdf_looks(const UrdfGeometry& g, const Pose& body_from_link, RobotModel& model, std::size_t body,
                    MeshImporter& importer, std::vector<std::string>& warnings);

}  // namespace rubble
