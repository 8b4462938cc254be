// Frames and inertial readings out of ROS bags and MCAP files, in their order.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "io/recording/recording.h"
#include "render/scene/sample.h"

namespace rubble {

struct RosSampleSource {
  std::string path;                    // of the bag or MCAP file
  Recording recording;                 // whose topics are in it
  std::vector<Intrinsics> intrinsics;  // of each camera
  // True poses of what carries each camera, by stamp (unit: ns); empty: the rig does, whose poses are in the file.
  std::vector<std::map<std::int64_t, Pose>> carriers;
};

// Velocity of a point that is fixed to a moving body: the difference of the poses around the stamp, which is one of them.
Vec3 velocity_at(const std::map<std::int64_t, Pose>& world_from_body, std::int64_t stamp_ns, const Vec3& point_in_body);

// What the file does not hold as it was measured.
struct RosLosses {
  bool whole_millimetres = false;  // depth
  bool jpeg = false;               // colour
};

// Gives every frame; velocities are those of velocity_at(), since none are recorded. Throws InputError: the file is damaged (with the byte), or
// a frame lacks a topic of the recording.
RosLosses read_ros_frames(const RosSampleSource& source, const std::function<void(Frame)>& take);

// The readings of all inertial units, without the biases, which are no messages. Throws InputError likewise.
std::vector<ImuSample> read_ros_imus(const std::string& path, const Recording& recording);

}  // namespace rubble
