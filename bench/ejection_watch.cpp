#include "bench/ejection_watch.h"

#include <cmath>

namespace rubble {

void EjectionWatch::look() {
  last_.resize(std::size_t(world_.size()));
  seen_.resize(last_.size(), 0);
  for (int i = 0; i < world_.size(); ++i) {
    const auto slot = std::size_t(i);
    if (seen_[slot] || !world_.is_awake(i)) continue;
    const PieceState piece = world_.piece(i);
    const Vec3 v = piece.linear_velocity;
    if (std::hypot(v.x, v.y) > kEjectionSpeed || v.z > kEjectionSpeed) {
      seen_[slot] = 1;
      ejected_.push_back({i, world_.steps(), last_[slot], v, piece.world_from_body.translation});
    }
    last_[slot] = v;
  }
}

}  // namespace rubble
