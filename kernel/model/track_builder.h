// Makes a Track, sample by sample.
#pragma once

#include <cstdint>

#include "kernel/model/track.h"

namespace rubble {

// What a body does at the present sample.
struct BodySample {
  std::int32_t id = 0;    // as TrackBody::id
  Vec3 centre;            // centre of mass, in the body's frame; what the first sample says counts
  Pose world_from_body;   // unit: m
  Vec3 linear_velocity;   // of the centre of mass, in the world; unit: m/s
  Vec3 angular_velocity;  // in the world; unit: rad/s
};

class TrackBuilder {
 public:
  TrackBuilder() = default;
  // Goes on from a track. Doing so after forget_from(t) gives the same track, bit for bit, as never
  // having stopped at t.
  explicit TrackBuilder(Track so_far) : track_(std::move(so_far)) {}

  void begin_sample(double time);  // later than the sample before (assertion); unit: s
  // At most once a body and sample. A body that is where it was takes no room; one that was not there
  // before appears; one that was removed does not come back (assertion).
  void set(const BodySample& body);
  void remove(std::int32_t id);  // no more from this sample on; unknown and removed ones: no effect

  // Forgets every sample at `time` and later; unit: s
  void forget_from(double time);

  const Track& track() const { return track_; }
  Track take() { return std::move(track_); }

 private:
  TrackBody& find_or_add(const BodySample& body);

  Track track_;
};

}  // namespace rubble
