#include "kernel/queries/queries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "kernel/geometry/fine_shapes.h"
#include "kernel/geometry/shape.h"
#include "kernel/queries/query_tree.h"

namespace rubble {
namespace {

void expect(bool fine, const char* message) {
  if (!fine) throw std::invalid_argument(message);
}

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

QueryMesh make_mesh(const TriangleMesh& mesh) {
  QueryMesh result;
  for (const auto& corners : mesh.triangles) {
    for (std::uint32_t corner : corners) {
      expect(corner < mesh.positions.size(), "PileQueries: a triangle without its corners");
    }
    result.triangles.push_back({Vec3(mesh.positions[corners[0]]), Vec3(mesh.positions[corners[1]]),
                                Vec3(mesh.positions[corners[2]])});
  }
  return result;
}

QueryPiece make_piece(const PieceState& state, int index, int mesh_index, const QueryMesh& mesh) {
  QueryPiece piece;
  piece.index = index;
  piece.mesh = mesh_index;
  piece.scale = state.scale;
  piece.rotation = normalized(state.world_from_body.rotation).matrix();
  piece.position = state.world_from_body.translation;
  for (const QueryTriangle& triangle : mesh.triangles) {
    for (const Vec3& corner : {triangle.a, triangle.b, triangle.c}) {
      piece.box.include(piece.to_world(corner));
    }
  }
  return piece;
}

void add_fines(const PileState& pile, std::vector<QueryMesh>& meshes, std::vector<QueryPiece>& pieces) {
  const std::vector<FineHeap>& heaps = pile.fines.heaps();
  for (std::size_t i = 0; i < heaps.size(); ++i) {
    PieceState state;
    state.world_from_body = world_from_host(pile, heaps[i].host);
    meshes.push_back(make_mesh(heaps[i].mesh));
    pieces.push_back(make_piece(state, kFirstFineHeap + int(i), int(meshes.size()) - 1, meshes.back()));
  }
}

void add_surroundings(const PileState& pile, std::vector<QueryMesh>& meshes, std::vector<QueryPiece>& pieces) {
  if (!pile.surroundings) return;
  const int first = int(meshes.size());
  for (const auto& mesh : pile.surroundings->meshes) meshes.push_back(make_mesh(mesh->leafy ? mesh->levels.back() : mesh->levels.front()));
  int number = kFirstSurrounding;
  for (const SurroundingThing& thing : pile.surroundings->things) {
    PieceState state;
    state.world_from_body = thing.world_from_mesh, state.scale = thing.scale;
    const int mesh = first + int(thing.mesh);
    QueryMesh& of_it = meshes[std::size_t(mesh)];
    of_it.smallest_scale = std::min(of_it.smallest_scale, thing.scale);
    pieces.push_back(make_piece(state, number++, mesh, of_it));
  }
}

QueryTree make_tree(const PileState& pile, const std::vector<const TriangleMesh*>& meshes) {
  std::vector<int> number(meshes.size(), -1);
  std::vector<QueryMesh> used;
  std::vector<QueryPiece> pieces;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& state = pile.pieces[i];
    if (state.status == PieceStatus::lost) continue;
    const std::size_t type = std::size_t(state.type);
    expect(state.type >= 0 && type < meshes.size() && meshes[type] != nullptr,
           "PileQueries: a piece without a mesh");
    if (number[type] < 0) {
      number[type] = int(used.size());
      used.push_back(make_mesh(*meshes[type]));
      used.back().smallest_scale = state.scale;
    }
    QueryMesh& mesh = used[std::size_t(number[type])];
    if (mesh.triangles.empty()) continue;
    mesh.smallest_scale = std::min(mesh.smallest_scale, state.scale);
    pieces.push_back(make_piece(state, int(i), number[type], mesh));
  }
  add_fines(pile, used, pieces);
  add_surroundings(pile, used, pieces);
  return {std::move(used), std::move(pieces)};
}

// Keeps the nearest answer and those that are as near to within kQueryTie, and picks one of them
// that does not depend on the order in which they came.
class Nearest {
 public:
  struct Candidate {
    double distance;
    int piece, triangle;  // numbers in the tree
    Vec3 point;
  };

  explicit Nearest(double limit) : best_(limit), limit_(limit) {}

  void add(const Candidate& candidate) {
    if (candidate.distance > limit()) return;
    best_ = std::min(best_, candidate.distance);
    candidates_.push_back(candidate);
  }
  // Answers beyond it are of no interest.
  double limit() const { return std::min(limit_, best_ + kQueryTie); }

  // The lowest piece; of its answers the nearest; of those the lowest triangle. Null: none.
  const Candidate* pick() const {
    const Candidate* picked = nullptr;
    for (const Candidate& c : candidates_) {
      if (c.distance > limit()) continue;
      if (!picked ||
          std::make_pair(c.piece, std::make_pair(c.distance, c.triangle)) <
              std::make_pair(picked->piece, std::make_pair(picked->distance, picked->triangle))) {
        picked = &c;
      }
    }
    return picked;
  }
  double best() const { return best_; }

 private:
  double best_, limit_;
  std::vector<Candidate> candidates_;
};

// Of a mesh with more than so many, the inside is told by a ray.
constexpr std::size_t kManyTriangles = 5000;

// A piece and what a query is in its frame: triangles of one piece are offered one after another.
template <typename Local>
struct Cached {
  int piece = -1;
  Local local{};
};

}  // namespace

struct PileQueries::Impl {
  Impl(const PileState& pile, const std::vector<const TriangleMesh*>& meshes, bool with_ground)
      : tree(make_tree(pile, meshes)), ground(with_ground) {}

  const QueryTriangle& triangle(int piece, int index) const {
    return tree.meshes()[std::size_t(tree.pieces()[std::size_t(piece)].mesh)]
        .triangles[std::size_t(index)];
  }
  const QueryPiece& piece(int index) const { return tree.pieces()[std::size_t(index)]; }

  // Calls found(piece, distance, point) for triangles near a point; returns as VisitTriangle does.
  template <typename Found>
  void around(const Vec3& point, double limit, Found&& found) const {
    Cached<Vec3> cached;
    tree.around(point, limit, [&](int number, int index) {
      const QueryPiece& p = piece(number);
      if (cached.piece != number) cached = {number, p.to_local(point)};
      const Vec3 closest = rubble::find_closest(triangle(number, index), cached.local);
      return found(number, index, rubble::distance(closest, cached.local) * p.scale, closest);
    });
  }

  Nearest find_nearest(const Vec3& point, double limit) const {
    Nearest nearest(limit);
    around(point, limit, [&](int number, int index, double distance, const Vec3& closest) {
      nearest.add({distance, number, index, closest});
      return nearest.limit();
    });
    return nearest;
  }

  // Calls inside(number) for each piece that a point is inside of, until it returns false.
  template <typename Inside>
  void containing(const Vec3& point, Inside&& inside) const {
    bool go_on = true;
    tree.at(point, [&](int number) {
      if (!go_on) return;
      const bool is_inside = mesh_of(number).triangles.size() > kManyTriangles
                                 ? leaves(number, point)
                                 : winding(number, point) > 0.5;
      if (is_inside) go_on = inside(number);
    });
  }

  double winding(int number, const Vec3& point) const {
    const Vec3 local = piece(number).to_local(point);
    double sum = 0;
    for (const QueryTriangle& t : mesh_of(number).triangles) sum += calc_winding(t, local);
    return sum;
  }

  // For terrain, whose triangles are too many for the winding: whether a ray that goes up meets its
  // surface from behind first. The ray is not quite upright, so as not to run along walls.
  bool leaves(int number, const Vec3& point) const {
    const QueryPiece& p = piece(number);
    const Vec3 direction = normalized(Vec3{0.0131, 0.0237, 1});
    const Vec3 local = p.to_local(point), local_direction = p.turn_to_local(direction);
    double nearest = std::numeric_limits<double>::infinity();
    bool from_behind = false;
    tree.along_ray(point, direction, nearest, [&](int other, int index) {
      if (other != number) return nearest;
      const QueryTriangle& t = triangle(number, index);
      const auto distance = find_hit(t, local, local_direction);
      if (distance && *distance < nearest) {
        nearest = *distance;
        from_behind = dot(cross(t.b - t.a, t.c - t.a), local_direction) > 0;
      }
      return nearest;
    });
    return from_behind;
  }

  const QueryMesh& mesh_of(int number) const {
    return tree.meshes()[std::size_t(piece(number).mesh)];
  }

  QueryTree tree;
  bool ground;
};

PileQueries::PileQueries(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                         bool ground)
    : impl_(std::make_unique<Impl>(pile, meshes, ground)) {}
PileQueries::~PileQueries() = default;
PileQueries::PileQueries(PileQueries&&) noexcept = default;
PileQueries& PileQueries::operator=(PileQueries&&) noexcept = default;

std::optional<RayHit> PileQueries::cast_ray(const Vec3& origin, const Vec3& direction,
                                            double max_distance) const {
  expect(is_finite(origin) && is_finite(direction) && norm(direction) > 0 && max_distance >= 0,
         "cast_ray: a point that is not finite, a direction of length 0 or a negative distance");
  const Vec3 d = normalized(direction);
  struct LocalRay {
    Vec3 origin, direction;
  };
  Cached<LocalRay> cached;
  Nearest nearest(max_distance);
  impl_->tree.along_ray(origin, d, max_distance, [&](int number, int index) {
    const QueryPiece& p = impl_->piece(number);
    if (cached.piece != number) cached = {number, {p.to_local(origin), p.turn_to_local(d)}};
    const auto t =
        find_hit(impl_->triangle(number, index), cached.local.origin, cached.local.direction);
    if (t) nearest.add({*t, number, index, {}});
    return nearest.limit();
  });
  const Nearest::Candidate* picked = nearest.pick();
  if (impl_->ground && d.z != 0) {
    const double t = -origin.z / d.z;
    if (t >= 0 && t <= max_distance && !(picked && nearest.best() <= t + kQueryTie)) {
      Vec3 point = origin + d * t;
      point.z = 0;
      return RayHit{t, point, {0, 0, 1}, kGroundPiece};
    }
  }
  if (!picked) return std::nullopt;
  const QueryPiece& p = impl_->piece(picked->piece);
  const QueryTriangle& t = impl_->triangle(picked->piece, picked->triangle);
  return RayHit{picked->distance, origin + d * picked->distance,
                p.rotation * normalized(cross(t.b - t.a, t.c - t.a)), p.index};
}

std::optional<ClosestPoint> PileQueries::find_closest(const Vec3& point,
                                                      double max_distance) const {
  expect(is_finite(point) && max_distance >= 0,
         "find_closest: a point that is not finite or a negative distance");
  const double height = impl_->ground ? std::abs(point.z) : std::numeric_limits<double>::infinity();
  const double limit = std::min(max_distance, height + kQueryTie);
  const Nearest nearest = impl_->find_nearest(point, limit);
  if (const Nearest::Candidate* picked = nearest.pick()) {
    const QueryPiece& p = impl_->piece(picked->piece);
    return ClosestPoint{picked->distance, p.to_world(picked->point), p.index};
  }
  if (impl_->ground && height <= max_distance) {
    return ClosestPoint{height, {point.x, point.y, 0}, kGroundPiece};
  }
  return std::nullopt;
}

std::vector<int> PileQueries::find_overlaps(const Vec3& centre, double radius) const {
  expect(is_finite(centre) && radius >= 0,
         "find_overlaps: a point that is not finite or a negative radius");
  std::vector<int> found;
  impl_->around(centre, radius, [&](int number, int, double distance, const Vec3&) {
    if (distance <= radius && (found.empty() || found.back() != number)) found.push_back(number);
    return radius;
  });
  impl_->containing(centre, [&](int number) {
    found.push_back(number);
    return true;
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (int& number : found) number = impl_->piece(number).index;
  return found;
}

double PileQueries::clearance(const Vec3& point, double max_distance) const {
  expect(is_finite(point) && max_distance >= 0,
         "clearance: a point that is not finite or a negative distance");
  if (impl_->ground && point.z <= 0) return 0;
  bool free = true;
  impl_->containing(point, [&](int) { return free = false; });
  return free ? clearance_outside(point, max_distance) : 0;
}

double PileQueries::clearance_outside(const Vec3& point, double max_distance) const {
  expect(is_finite(point) && max_distance >= 0,
         "clearance: a point that is not finite or a negative distance");
  if (impl_->ground && point.z <= 0) return 0;
  const double limit = impl_->ground ? std::min(max_distance, point.z) : max_distance;
  return std::min(limit, impl_->find_nearest(point, limit).best());
}

std::vector<TriangleMesh> make_collision_meshes(const std::vector<PieceType>& types) {
  std::vector<TriangleMesh> meshes;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const Shape shape = compile_shape(types[i], "types[" + std::to_string(i) + "]");
    TriangleMesh mesh;
    if (types[i].surface) mesh = *types[i].surface;
    for (const ConvexShape& part : shape.parts) {
      const std::uint32_t base = std::uint32_t(mesh.positions.size());
      for (const Vec3f& corner : part.corners) {
        mesh.positions.push_back(Vec3f(Vec3(corner) + shape.volume.centre_of_mass));
      }
      for (const ConvexShape::Face& face : part.faces) {
        for (int k = 2; k < face.count; ++k) {
          mesh.triangles.push_back({base + part.loops[face.first],
                                    base + part.loops[face.first + k - 1],
                                    base + part.loops[face.first + k]});
        }
      }
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace rubble
