#include "kernel/settling/track_recorder.h"

#include "kernel/world/world.h"

namespace rubble {

void TrackRecorder::observe(const World& world) {
  if (world.steps() == last_step_) return;
  if (last_step_ < 0) builder_.forget_from(world.time());
  last_step_ = world.steps();
  builder_.begin_sample(world.time());
  for (int i = 0; i < world.size(); ++i) {
    const PieceState piece = world.piece(i);
    if (piece.status == PieceStatus::lost) {
      builder_.remove(i);
    } else {
      builder_.set({i, world.centre_of_mass(i), piece.world_from_body, piece.linear_velocity,
                    piece.angular_velocity});
    }
  }
}

}  // namespace rubble
