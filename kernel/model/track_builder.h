// Makes a Track, sample by sample.
#pragma once

#include <cstdint>

#include "kernel/model/track.h"

namespace rubble {

// A body at the current sample.
struct BodySample {
  std::int32_t id = 0;    // as TrackBody::id
  Vec3 centre;            // centre of mass, in the body's frame; only that of the first sample is used
  Pose world_from_body;   // unit: m
  Vec3 linear_velocity;   // of the centre of mass, in the world; unit: m/s
  Vec3 angular_velocity;  // in the world; unit: rad/s
};

class TrackBuilder {
 public:
  TrackBuilder() = default;
  // Continues a track. After forget_from(t) this gives the same track, bit for bit, as a recording without
  // a stop at t.
  explicit TrackBuilder(Track so_far) : track_(std::move(so_far)) {}

  void begin_sample(double time);  // later than the sample before (assertion); unit: s
  // At most once per body and sample. An unmoved body adds no key, and an unknown one appears. A removed body cannot
  // return (assertion).
  void set(const BodySample& body);
  void remove(std::int32_t id);  // from this sample on; no effect on unknown and removed bodies

  // Forgets every sample at `time` and later; unit: s
  void forget_from(double time);

  const Track& track() const { return track_; }
  Track take() { return std::move(track_); }

 private:
  TrackBody& find_or_add(const BodySample& body);

  Track track_;
};

}  // namespace rubble
