#include "kernel/queries/query_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/system/embree.h"

namespace rubble {
namespace {

// Of the size of the pile: more than a hundred roundings in single precision.
constexpr double kMarginFraction = 8e-6;
constexpr double kSmallestMargin = 1e-6;  // unit: m

void enlarge(Aabb& box, double margin) {
  const Vec3 grow{margin, margin, margin};
  box.min -= grow;
  box.max += grow;
}

void write_bounds(const Aabb& box, RTCBounds& bounds) {
  bounds.lower_x = float(box.min.x), bounds.lower_y = float(box.min.y);
  bounds.lower_z = float(box.min.z), bounds.upper_x = float(box.max.x);
  bounds.upper_y = float(box.max.y), bounds.upper_z = float(box.max.z);
}

// The part of a ray within a box; empty when first > second.
std::pair<double, double> clip(const Aabb& box, const Vec3& origin, const Vec3& direction,
                               double limit) {
  double enter = 0, leave = limit;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (origin[i] < box.min[i] || origin[i] > box.max[i]) return {1, 0};
      continue;
    }
    const double one = (box.min[i] - origin[i]) / direction[i];
    const double two = (box.max[i] - origin[i]) / direction[i];
    enter = std::max(enter, std::min(one, two));
    leave = std::min(leave, std::max(one, two));
  }
  return {enter, leave};
}

struct BoundedMesh {
  const QueryMesh* mesh;
  double margin;  // at scale 1; unit: m
};

void bound_triangle(const RTCBoundsFunctionArguments* args) {
  const auto& bounded = *static_cast<const BoundedMesh*>(args->geometryUserPtr);
  const QueryTriangle& triangle = bounded.mesh->triangles[args->primID];
  Aabb box;
  for (const Vec3& corner : {triangle.a, triangle.b, triangle.c}) box.include(corner);
  enlarge(box, bounded.margin);
  write_bounds(box, *args->bounds_o);
}

struct RayVisit : EmbreeRayContext {
  const QueryTree::VisitTriangle* visit = nullptr;
  double start = 0, margin = 0;
};

void visit_by_ray(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& query = *static_cast<RayVisit*>(args->context);
  // For one ray, RTCRayHitN is RTCRayHit.
  RTCRay& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
  const double limit = (*query.visit)(int(query.instID[0]), int(args->primID));
  ray.tfar = std::min(ray.tfar, float(limit - query.start + query.margin));
}

// A point query that started in the tree of boxes and goes on in the trees of triangles.
struct PointVisit {
  const QueryTree::VisitTriangle* visit;
  const QueryTree* tree;
  const std::vector<RTCScene>* meshes;
  Vec3 point;
  double limit, margin;
  int piece = -1;
};

bool shrink(RTCPointQuery& query, double radius) {
  if (!(float(radius) < query.radius)) return false;
  query.radius = float(radius);
  return true;
}

RTCPointQuery make_point_query(const Vec3& at, double radius) {
  RTCPointQuery query{};
  query.x = float(at.x), query.y = float(at.y), query.z = float(at.z);
  query.radius = float(radius);
  return query;
}

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  auto& query = *static_cast<PointVisit*>(args->userPtr);
  query.limit = (*query.visit)(query.piece, int(args->primID));
  const double scale = query.tree->pieces()[std::size_t(query.piece)].scale;
  return shrink(*args->query, (query.limit + query.margin) / scale);
}

// One tree after the other: point queries through Embree's own instances (3.13) were seen to
// leave out triangles.
bool visit_piece(RTCPointQueryFunctionArguments* args) {
  auto& query = *static_cast<PointVisit*>(args->userPtr);
  query.piece = int(args->primID);
  const QueryPiece& piece = query.tree->pieces()[args->primID];
  RTCPointQuery local =
      make_point_query(piece.to_local(query.point), (query.limit + query.margin) / piece.scale);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery((*query.meshes)[std::size_t(piece.mesh)], &local, &context, visit_triangle, &query);
  return shrink(*args->query, query.limit + query.margin);
}

}  // namespace

struct QueryTree::Trees {
  Trees() : device(rtcNewDevice("threads=1,set_affinity=0")) {
    if (!device) throw RunError("cannot query the pile: Embree gives no device");
  }
  ~Trees() {
    for (RTCScene scene : meshes) rtcReleaseScene(scene);
    if (instances) rtcReleaseScene(instances);
    if (boxes) rtcReleaseScene(boxes);
    rtcReleaseDevice(device);
  }
  Trees(const Trees&) = delete;
  Trees& operator=(const Trees&) = delete;

  RTCScene make_scene() const {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    return scene;
  }
  static void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device;
  std::vector<RTCScene> meshes;
  RTCScene instances = nullptr, boxes = nullptr;
  std::vector<BoundedMesh> bounded;
  std::vector<Aabb> piece_boxes;  // in Embree's coordinates, enlarged
};

QueryTree::QueryTree(std::vector<QueryMesh> meshes, std::vector<QueryPiece> pieces)
    : meshes_(std::move(meshes)), pieces_(std::move(pieces)), trees_(std::make_unique<Trees>()) {
  for (const QueryPiece& piece : pieces_) box_.include(piece.box.min), box_.include(piece.box.max);
  if (!pieces_.empty()) {
    centre_ = (box_.min + box_.max) * 0.5;
    // Also covers the distance of a type's mesh from the origin of its frame.
    double size = norm(box_.max - box_.min);
    for (const QueryPiece& piece : pieces_) size = std::max(size, norm(piece.position - centre_));
    margin_ = std::max(kSmallestMargin, kMarginFraction * size);
    enlarge(box_, margin_);
  }
  build_meshes();
  build_pieces();
  if (rtcGetDeviceError(trees_->device) != RTC_ERROR_NONE) {
    throw RunError("cannot query the pile: Embree reports an error while building its trees");
  }
}

QueryTree::~QueryTree() = default;

void QueryTree::build_meshes() {
  for (const QueryMesh& mesh : meshes_) {
    trees_->bounded.push_back({&mesh, margin_ / mesh.smallest_scale});
  }
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    RTCScene scene = trees_->make_scene();
    trees_->meshes.push_back(scene);
    RTCGeometry geometry = rtcNewGeometry(trees_->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(meshes_[i].triangles.size()));
    rtcSetGeometryUserData(geometry, &trees_->bounded[i]);
    rtcSetGeometryBoundsFunction(geometry, bound_triangle, nullptr);
    rtcSetGeometryIntersectFunction(geometry, visit_by_ray);
    Trees::attach(scene, geometry, 0);
    rtcCommitScene(scene);
  }
}

void QueryTree::build_pieces() {
  trees_->instances = trees_->make_scene();
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const QueryPiece& piece = pieces_[i];
    const Vec3 at = piece.position - centre_;
    float transform[12];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        transform[4 * row + column] = float(piece.rotation.rows[row][column] * piece.scale);
      }
      transform[4 * row + 3] = float(at[row]);
    }
    RTCGeometry instance = rtcNewGeometry(trees_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, trees_->meshes[std::size_t(piece.mesh)]);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, transform);
    Trees::attach(trees_->instances, instance, unsigned(i));
    Aabb box{piece.box.min - centre_, piece.box.max - centre_};
    enlarge(box, margin_);
    trees_->piece_boxes.push_back(box);
  }
  rtcCommitScene(trees_->instances);

  trees_->boxes = trees_->make_scene();
  RTCGeometry geometry = rtcNewGeometry(trees_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(pieces_.size()));
  rtcSetGeometryUserData(geometry, trees_->piece_boxes.data());
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        write_bounds(static_cast<const Aabb*>(args->geometryUserPtr)[args->primID],
                     *args->bounds_o);
      },
      nullptr);
  Trees::attach(trees_->boxes, geometry, 0);
  rtcCommitScene(trees_->boxes);
}

void QueryTree::along_ray(const Vec3& origin, const Vec3& direction, double limit,
                          const VisitTriangle& visit) const {
  if (pieces_.empty()) return;
  const auto [enter, leave] = clip(box_, origin, direction, limit);
  if (enter > leave) return;
  RayVisit context;
  context.visit = &visit;
  context.start = enter;
  context.margin = margin_;
  const Vec3f from(origin + direction * enter - centre_), d(direction);
  RTCRayHit query{};
  query.ray = {from.x,      from.y, from.z, 0, d.x, d.y, d.z, 0, float(leave - enter + margin_),
               0xffffffffu, 0,      0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_intersect(trees_->instances, query, context);
}

void QueryTree::around(const Vec3& point, double limit, const VisitTriangle& visit) const {
  if (pieces_.empty()) return;
  const Vec3 from = point - centre_;
  // What is beyond the farthest corner of the pile is beyond everything.
  const double away = norm(from), farthest = away + norm(box_.max - box_.min);
  const double margin = margin_ + kMarginFraction * away;
  PointVisit visitor{&visit, this, &trees_->meshes, point, std::min(limit, farthest), margin};
  RTCPointQuery query = make_point_query(from, visitor.limit + margin);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(trees_->boxes, &query, &context, visit_piece, &visitor);
}

void QueryTree::at(const Vec3& point, const std::function<void(int piece)>& visit) const {
  for (int i = 0; i < 3; ++i) {
    if (point[i] < box_.min[i] || point[i] > box_.max[i]) return;
  }
  RTCPointQuery query = make_point_query(point - centre_, margin_);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto call = [](RTCPointQueryFunctionArguments* args) {
    (*static_cast<const std::function<void(int)>*>(args->userPtr))(int(args->primID));
    return false;
  };
  rtcPointQuery(trees_->boxes, &query, &context, call,
                const_cast<std::function<void(int)>*>(&visit));
}

}  // namespace rubble
