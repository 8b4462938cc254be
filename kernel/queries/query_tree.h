// The pieces of a pile in Embree's trees: one tree of triangles per type, one of its instances, one
// of the boxes of whole pieces. Not for use outside kernel/.
//
// Embree works in single precision. Here it only says which triangles to look at: their boxes are
// enlarged by more than its rounding, and every triangle is tested in double precision. So each
// answer is that of trying all triangles, whatever the order in which Embree offers them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "kernel/queries/query_triangle.h"

namespace rubble {

struct QueryMesh {
  std::vector<QueryTriangle> triangles;  // at scale 1
  double smallest_scale = 1;             // of the pieces that use it
};

struct QueryPiece {
  int index = 0;     // in the pile
  int mesh = 0;      // index into the meshes of the tree
  double scale = 1;  // of the mesh's lengths; above 0
  Mat3 rotation;     // world from piece
  Vec3 position;
  Aabb box;  // in the world

  Vec3 to_world(const Vec3& p) const { return rotation * (p * scale) + position; }
  Vec3 turn_to_local(const Vec3& d) const { return rotation.transposed() * d * (1 / scale); }
  Vec3 to_local(const Vec3& p) const { return turn_to_local(p - position); }
};

class QueryTree {
 public:
  QueryTree(std::vector<QueryMesh> meshes, std::vector<QueryPiece> pieces);
  ~QueryTree();

  const std::vector<QueryMesh>& meshes() const { return meshes_; }
  const std::vector<QueryPiece>& pieces() const { return pieces_; }

  // Each of these offers everything within a limit, and more; the visitor returns the new limit,
  // never larger than the one before.
  using VisitTriangle = std::function<double(int piece, int triangle)>;
  // direction: unit length. limit: along the ray.
  void along_ray(const Vec3& origin, const Vec3& direction, double limit,
                 const VisitTriangle& visit) const;
  // limit: distance from the point.
  void around(const Vec3& point, double limit, const VisitTriangle& visit) const;
  // The pieces in whose box a point lies.
  void at(const Vec3& point, const std::function<void(int piece)>& visit) const;

 private:
  struct Trees;
  void build_meshes();
  void build_pieces();

  std::vector<QueryMesh> meshes_;
  std::vector<QueryPiece> pieces_;
  Aabb box_;           // of all pieces, enlarged
  Vec3 centre_;        // origin of Embree's coordinates
  double margin_ = 0;  // more than Embree's rounding; unit: m
  std::unique_ptr<Trees> trees_;
};

}  // namespace rubble
