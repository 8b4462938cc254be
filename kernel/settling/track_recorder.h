// Keeps the track of a world: who moved when, at every step.
#pragma once

#include <cstdint>

#include "kernel/model/track.h"
#include "kernel/model/track_builder.h"

namespace rubble {

class World;

class TrackRecorder {
 public:
  TrackRecorder() = default;
  // Goes on from what was recorded before a pause: what it holds of the first step that is observed, or
  // of later ones, is forgotten and comes again.
  explicit TrackRecorder(Track so_far) : builder_(std::move(so_far)) {}

  // Between two steps; a WorldObserver. A step that was seen already is not taken again.
  void observe(const World& world);

  const Track& track() const { return builder_.track(); }
  Track take() { return builder_.take(); }

 private:
  std::int64_t last_step_ = -1;
  TrackBuilder builder_;
};

}  // namespace rubble
