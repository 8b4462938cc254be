// Questions about a settled pile: what a ray meets, what is nearest, what is within reach.
//
// For camera collision, path planning, label checks and void maps. World frame, lengths in metres.
// Results are those of the exact triangles in double precision, good to 1e-9 m at the distances of
// a pile, the same on every machine and for any number of threads. Pieces that are lost are not
// there. The fines of the pile are there: of a heap of them the piece is kFirstFineHeap and its index
// among make_fine_heaps(). So are its surroundings, from kFirstSurrounding on. Several threads may ask at once.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// Stands for a piece's index where the answer is the ground plane z = 0.
inline constexpr int kGroundPiece = -1;

// Of answers that are equally far, to within this, the piece with the lowest index is given, and
// the ground only when no piece is as near; unit: m.
inline constexpr double kQueryTie = 1e-9;

struct RayHit {
  double distance = 0;       // from the origin; unit: m
  Vec3 point;                // in the world; unit: m
  Vec3 normal;               // unit length, out of the surface, also when it is met from inside
  int piece = kGroundPiece;  // index into PileState::pieces, a heap of fines, of surroundings, or kGroundPiece
};

struct ClosestPoint {
  double distance = 0;       // to the surface, from either side; unit: m
  Vec3 point;                // on the surface
  int piece = kGroundPiece;  // as of a RayHit
};

class PileQueries {
 public:
  // meshes: by type index, in the frame of the type at scale 1; not kept. One that no piece uses
  // may be null. ground: whether the plane z = 0 counts as a surface, and below it as solid.
  // Throws std::invalid_argument for a piece without a mesh or a triangle without its corners, and
  // RunError when there is no memory.
  PileQueries(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
              bool ground = true);
  ~PileQueries();
  PileQueries(PileQueries&&) noexcept;
  PileQueries& operator=(PileQueries&&) noexcept;

  // Points must be finite, a direction not zero (of any length), distances and radii >= 0, also
  // infinite; std::invalid_argument otherwise.

  // The first surface on the way, met from either side, not farther than max_distance.
  std::optional<RayHit> cast_ray(const Vec3& origin, const Vec3& direction,
                                 double max_distance) const;
  // The nearest surface, not farther than max_distance.
  std::optional<ClosestPoint> find_closest(const Vec3& point, double max_distance) const;
  // The pieces that a ball touches, is inside of or contains; ascending. Never the ground.
  std::vector<int> find_overlaps(const Vec3& centre, double radius) const;
  // How far a point is from everything solid, at most max_distance (the smaller, the faster); 0
  // inside a piece and below the ground.
  double clearance(const Vec3& point,
                   double max_distance = std::numeric_limits<double>::infinity()) const;
  // The same of a point that is known to be outside of every piece, in less time.
  double clearance_outside(const Vec3& point,
                           double max_distance = std::numeric_limits<double>::infinity()) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The convex parts of each type as a mesh, for queries on what the physics sees.
std::vector<TriangleMesh> make_collision_meshes(const std::vector<PieceType>& types);

}  // namespace rubble
