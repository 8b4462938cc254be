// What cameras have in view, as lines: from each camera to the border of its image at some distance.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/drive/overlay/overlay.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// A camera of the mission where it is.
struct PlacedCamera {
  std::string name;
  Intrinsics intrinsics;
  Pose world_from_camera;                // body frame: X forward, Y left, Z up
  std::array<std::uint8_t, 3> colour{};  // of its lines
};

// Cameras on carriers that are known now: carrier_of gives where a camera's carrier is; nothing: the
// camera is left out. Colours differ.
std::vector<PlacedCamera> place_cameras(const std::vector<MountedCamera>& cameras,
                                        const std::function<std::optional<Pose>(const MountedCamera&)>& carrier_of);

// The border of its image in the plane at `distance`, bent where the lens distorts, lines to its corners, and a tick on its
// upper side. Of a lens that sees farther than 75 degrees to the side the border is at that distance along each ray. unit: m
void add_frustum(const PlacedCamera& camera, double distance, std::vector<OverlayLine>& lines);

// Steps of a flight as a line; between points that are nearer than `least` nothing is drawn. unit: m
void add_path(const std::vector<Vec3>& points, double least, std::vector<OverlayLine>& lines);

}  // namespace rubble
