// Notices a camera that flies through solid matter, or below the ground: it sees the inside of a wall, or through it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// A sentence that names the first frame whose camera is inside a piece, that piece, or below the ground, and how many frames
// there are; nothing: none is. By the winding number of the piece's mesh about the camera, which is 1
// inside of a closed mesh and 0 outside (Jacobson, Kavan and Sorkine-Hornung 2013). Fines and surroundings are not looked at.
// who: "the camera", or another sensor.
std::optional<std::string> find_camera_inside(const AssetLibrary& assets, const PileState& pile,
                                              const std::vector<Vec3>& positions, const std::string& who = "the camera");

// 1 inside of a closed mesh whose triangles face outwards, 0 outside.
double calc_winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace rubble
