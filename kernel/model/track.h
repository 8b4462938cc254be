// Motion of bodies over simulated time, with keys where they moved.
//
// A track gives the poses of the pieces of a pile and of the links of a robot at any time. A resting body
// needs no keys: it stays at its last key. TrackBuilder makes tracks, io/state/track_file saves and loads them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Pose and velocities of a body at one sample.
struct TrackKey {
  std::uint32_t sample = 0;  // index into Track::times
  Pose world_from_body;      // body: the frame of the piece's type, or of the link; unit: m
  Vec3f linear_velocity;     // of the centre of mass, in the world; unit: m/s
  Vec3f angular_velocity;    // in the world; unit: rad/s
};

// One body. It appears with its first key and stays at the pose of its last key.
struct TrackBody {
  static constexpr std::uint32_t kStays = 0xffffffffu;

  std::int32_t id = 0;           // of a piece: its index in the pile; range: 0 and up
  Vec3 centre;                   // centre of mass, in the body's frame; unit: m
  std::uint32_t gone = kStays;   // the first sample without the body
  std::vector<TrackKey> keys;    // by rising sample; at least one
};

// A body at one time.
struct BodyMotion {
  Pose world_from_body;   // unit: m
  // Derivatives of the interpolated motion; 0 at rest.
  Vec3 linear_velocity;   // of the body frame's origin, in the world; unit: m/s
  Vec3 angular_velocity;  // in the world; unit: rad/s

  // Velocity of the point of the body that is at `point` in the world now; unit: m/s
  Vec3 velocity_at(const Vec3& point) const {
    return linear_velocity + cross(angular_velocity, point - world_from_body.translation);
  }
};

// Between two keys the centre of mass follows the parabola of free flight if one agrees with both velocities and
// positions. Otherwise it follows a straight line, as the contact solver moves touching pieces. The rotation is
// about one axis at constant speed, with as many whole turns as the angular velocities of the keys indicate. At a
// key the pose is that of the key, bit for bit.
struct Track {
  std::vector<double> times;      // of the samples, rising; unit: s
  std::vector<TrackBody> bodies;  // by rising id

  bool empty() const { return times.empty(); }
  double begin() const { return times.empty() ? 0 : times.front(); }  // unit: s
  double end() const { return times.empty() ? 0 : times.back(); }     // unit: s

  const TrackBody* find(std::int32_t id) const;  // null: not in the track
  // Empty before the body appears and after it is gone. After the last sample every body keeps its pose.
  std::optional<BodyMotion> motion_at(const TrackBody& body, double time) const;
  // The same for all bodies, in their order.
  std::vector<std::optional<BodyMotion>> poses_at(double time) const;

  // Whether the body exists and keeps one pose from the first time to the second; unit: s
  bool rests_throughout(const TrackBody& body, double from, double to) const;

  // XXH64 over the bit patterns of every member in turn, each list after its length.
  std::uint64_t hash() const;
  // Describes the first violation of the rules above, such as a number that is not finite or an invalid rotation;
  // empty for a valid track. For readers of files.
  std::string find_fault() const;
};

}  // namespace rubble
