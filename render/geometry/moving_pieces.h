// Puts what moves in a prepared scene where it is at a time. Internal to render/.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/geometry/geometry.h"

namespace rubble {

class MovingPieces {
 public:
  // Of a scene without motion it does nothing and costs nothing. scene: the one that was prepared.
  MovingPieces(const Scene& scene, PreparedScene& prepared);

  bool any() const { return !motion_.moving.empty(); }
  // True where something is not where it was before.
  bool move_to(std::int64_t stamp_ns);
  // Nothing there, as before the first stamp: what rests alone.
  void remove_all();

  // How far what moves goes from where it is now.
  struct Shift {
    std::vector<std::uint8_t> moves;        // one a placed mesh; 0: it rests
    std::vector<std::optional<Pose>> then;  // where it will be, of those; nothing: not there
  };
  Shift shift_to(std::int64_t stamp_ns) const;

 private:
  void place(std::size_t i, const std::optional<Pose>& pose);

  SceneMotion motion_;
  PreparedScene& prepared_;
  std::optional<std::int64_t> now_;
  std::vector<std::optional<Pose>> poses_;  // as they were placed last
};

}  // namespace rubble
