// Records the track of a world: the motion of all pieces at every step.
#pragma once

#include <cstdint>

#include "kernel/model/track.h"
#include "kernel/model/track_builder.h"

namespace rubble {

class World;

class TrackRecorder {
 public:
  TrackRecorder() = default;
  // Continues a track that was recorded before a pause. Its samples from the first observed step on are forgotten
  // and recorded again.
  explicit TrackRecorder(Track so_far) : builder_(std::move(so_far)) {}

  // Call between two steps, as a WorldObserver. A repeated step is ignored.
  void observe(const World& world);

  const Track& track() const { return builder_.track(); }
  Track take() { return builder_.take(); }

 private:
  std::int64_t last_step_ = -1;
  TrackBuilder builder_;
};

}  // namespace rubble
