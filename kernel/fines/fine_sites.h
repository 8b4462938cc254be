// Sites where fines may lie: surfaces that face up, found along vertical lines through the whole pile. A site in a void
// counts as much as one under the sky. Each site is weighted by its area seen from above.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/fines/strew_fines.h"
#include "kernel/queries/queries.h"

namespace rubble {

struct FineSite {
  Vec3 point, normal;      // in the world; unit: m
  int host = kGroundPiece;  // index of the piece
  int source = -1;         // piece that sheds what lies here: the nearest beside it, or the host; -1: none near
  double headroom = 0;     // free height above; unit: m
  double corner = 0;       // how much of the horizon within kCornerReach is walls; range: 0 to 1
  double away = 0;         // from the pile, of a place on ground or terrain; 0 on a piece; unit: m
  Vec3 to_wall;            // to the nearest wall, level; zero without one
  double wall = 0;         // how far that is; unit: m
};

inline constexpr double kCornerReach = 0.3;  // unit: m

// lines: about so many vertical lines are looked along; at least 1.
std::vector<FineSite> find_fine_sites(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                                      const PileQueries& queries, int lines, const StrewOptions& options);

// Which of a pile's places gather more than others, by patches of 0.4 to 3 m; mean about 1.
class FinePatches {
 public:
  explicit FinePatches(std::uint64_t seed);
  double at(const Vec3& place) const;

 private:
  struct Wave {
    Vec3 turn;  // unit: rad/m
    double phase = 0;
  };
  std::vector<Wave> waves_;
};

// Which room is taken by fines already, so that they do not lie in each other.
class RoomForFines {
 public:
  // Takes the room of a ball where no other is nearer than kFineCloseness of their radii together; false and
  // nothing taken otherwise.
  bool take(const Vec3& centre, double radius);

 private:
  struct Ball {
    Vec3 centre;
    double radius;
  };
  std::unordered_map<std::uint64_t, std::vector<Ball>> cells_;  // asked, never walked
};

inline constexpr double kFineCloseness = 0.75;

}  // namespace rubble
