// Geometric queries on a settled pile: ray casts, closest points, overlaps, clearance.
//
// For camera collision, path planning, label checks and void maps. World frame, lengths in metres. Results are those
// of the exact triangles in double precision, accurate to 1e-9 m at the distances of a pile, and the same on every
// machine and for any number of threads. Lost pieces are left out. Fines are included: the number of a heap is
// kFirstFineHeap plus its index in Fines::heaps(). Surroundings are included, from kFirstSurrounding on. Several
// threads may call at once.
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

// Index of the ground plane z = 0 in results.
inline constexpr int kGroundPiece = -1;

// Of results whose distances differ by less than this, the piece with the lowest index is returned, and the ground
// only if no piece is as near; unit: m.
inline constexpr double kQueryTie = 1e-9;

struct RayHit {
  double distance = 0;       // from the origin; unit: m
  Vec3 point;                // in the world; unit: m
  Vec3 normal;               // unit length, outwards, also for a hit from inside
  int piece = kGroundPiece;  // index into PileState::pieces, number of a heap or of a surrounding, or kGroundPiece
};

struct ClosestPoint {
  double distance = 0;       // to the surface, from either side; unit: m
  Vec3 point;                // on the surface
  int piece = kGroundPiece;  // as of a RayHit
};

class PileQueries {
 public:
  // meshes: by type index, in the frame of the type at scale 1; copied. Meshes of unused types may be null. ground:
  // whether the plane z = 0 is a surface with solid below. Throws std::invalid_argument for a piece without a mesh or
  // a triangle with invalid corners, and RunError when memory is exhausted.
  PileQueries(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
              bool ground = true);
  ~PileQueries();
  PileQueries(PileQueries&&) noexcept;
  PileQueries& operator=(PileQueries&&) noexcept;

  // Points must be finite, a direction not zero (of any length), distances and radii >= 0, also
  // infinite; std::invalid_argument otherwise.

  // The first hit from either side, within max_distance.
  std::optional<RayHit> cast_ray(const Vec3& origin, const Vec3& direction,
                                 double max_distance) const;
  // The nearest surface within max_distance.
  std::optional<ClosestPoint> find_closest(const Vec3& point, double max_distance) const;
  // Pieces that a ball touches, contains or lies in; ascending. Never the ground.
  std::vector<int> find_overlaps(const Vec3& centre, double radius) const;
  // Distance from a point to the nearest solid, at most max_distance (smaller is faster); 0 inside a piece and below
  // the ground.
  double clearance(const Vec3& point,
                   double max_distance = std::numeric_limits<double>::infinity()) const;
  // The same for a point outside of every piece, in less time.
  double clearance_outside(const Vec3& point,
                           double max_distance = std::numeric_limits<double>::infinity()) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The convex parts of each type as a mesh, for queries on the collision geometry.
std::vector<TriangleMesh> make_collision_meshes(const std::vector<PieceType>& types);

}  // namespace rubble
