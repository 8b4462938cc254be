// Who moved when: the poses of bodies over simulated time, keyed where they moved.
//
// A track says of the pieces of a pile, and of the links of a robot, where they are at any time. Only
// what moves takes room: a body that rests keeps the last of its keys. TrackBuilder makes tracks,
// io/state/track_file saves and loads them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Where a body is at one sample, and how it moves there.
struct TrackKey {
  std::uint32_t sample = 0;  // index into Track::times
  Pose world_from_body;      // body: the frame of the piece's type, or of the link; unit: m
  Vec3f linear_velocity;     // of the centre of mass, in the world; unit: m/s
  Vec3f angular_velocity;    // in the world; unit: rad/s
};

// One body. It appears with its first key, and stays where its last key has it.
struct TrackBody {
  static constexpr std::uint32_t kStays = 0xffffffffu;

  std::int32_t id = 0;           // of a piece: its index in the pile; range: 0 and up
  Vec3 centre;                   // centre of mass, in the body's frame; unit: m
  std::uint32_t gone = kStays;   // the sample from which on it is no more
  std::vector<TrackKey> keys;    // by rising sample; at least one
};

// A body at one time.
struct BodyMotion {
  Pose world_from_body;   // unit: m
  // Derivatives of the interpolated motion: 0 for what rests.
  Vec3 linear_velocity;   // of the body frame's origin, in the world; unit: m/s
  Vec3 angular_velocity;  // in the world; unit: rad/s

  // Of a point that is fixed in the body and is at `point` in the world now; unit: m/s
  Vec3 velocity_at(const Vec3& point) const {
    return linear_velocity + cross(angular_velocity, point - world_from_body.translation);
  }
};

// Between two keys the centre of mass goes along the parabola of free flight where the two velocities
// and the way between them agree with one, and straight on otherwise, as the contact solver moves what
// touches. The rotation turns at constant speed about one axis, by as many whole turns as the angular
// velocities of the keys ask for. At a key the pose is the key's own, bit for bit.
struct Track {
  std::vector<double> times;      // of the samples, rising; unit: s
  std::vector<TrackBody> bodies;  // by rising id

  bool empty() const { return times.empty(); }
  double begin() const { return times.empty() ? 0 : times.front(); }  // unit: s
  double end() const { return times.empty() ? 0 : times.back(); }     // unit: s

  const TrackBody* find(std::int32_t id) const;  // null: not in the track
  // Nothing while the body is not there: before it appears, and from when it is gone. After the last
  // sample everything stays where it is.
  std::optional<BodyMotion> motion_at(const TrackBody& body, double time) const;
  // Of each body in turn.
  std::vector<std::optional<BodyMotion>> poses_at(double time) const;

  // Whether the body is there, and in one pose, from the first time to the second; unit: s
  bool rests_throughout(const TrackBody& body, double from, double to) const;

  // XXH64 over the bit patterns of every member in turn, each list after its length.
  std::uint64_t hash() const;
  // What contradicts the comments of the members above, numbers that are not finite and rotations
  // that are none included; empty for a sound track. For readers of files.
  std::string find_fault() const;
};

}  // namespace rubble
