#include "kernel/collision/surface_points.h"

#include <algorithm>
#include <cmath>

#include "kernel/collision/manifold.h"

namespace rubble {
namespace {

using EdgeConvexity = TriangleMeshShape::EdgeConvexity;

// Corners may lie this far outside a triangle: none falls between two. unit: m
constexpr float kSeam = 1e-4F;
// A part that is deeper than this behind a triangle does not belong to it; unit: m.
constexpr float kDeepest = 0.3F;
// Of an axis that neighbours are in the way of, another may be deeper by this; unit: m.
constexpr float kFallback = 0.05F;
// Axes nearer to the triangle's normal than this are that normal.
constexpr float kSameCosine = 0.9999F;
constexpr float kLeastCosine = 0.05F;  // least cosine between an axis and the triangle's normal on its free side
constexpr float kTouchGap = 1e-3F;  // of two that are moved apart until they touch; unit: m
constexpr float kAxisAdvantage = 5e-4F;  // another axis is used only if its overlap is smaller by this; unit: m

// A triangle seen from the centre of a piece, turned to the world.
struct PosedTriangle {
  const TriangleMeshShape::Triangle* triangle;
  Vec3f corners[3], normal;
  Vec3f outward[3];  // across each edge, in its plane; unit length
  float room[3];     // how far beyond each edge a corner still is over it; unit: m

  float height(const Vec3f& p) const { return dot(normal, p - corners[0]); }
  float beyond(int edge, const Vec3f& p) const { return dot(outward[edge], p - corners[edge]); }
  bool is_over(const Vec3f& p) const {
    return beyond(0, p) <= room[0] && beyond(1, p) <= room[1] && beyond(2, p) <= room[2];
  }
};

struct SurfaceAxis {
  Vec3f normal;  // out of the surface
  float separation = 0;
};

// One face for clipping, as a part: its front.
const ConvexShape& front_face() {
  static const ConvexShape shape = [] {
    ConvexShape s;
    s.faces.push_back({{0, 0, 1}, 0, 3});
    s.loops = {0, 1, 2};
    return s;
  }();
  return shape;
}

class SurfaceSearch {
 public:
  SurfaceSearch(const PosedPart& part, const Vec3& centre, const PosedSurface& surface, float margin,
         float reach, std::vector<SurfaceGap>& points)
      : part_(part), centre_(centre), surface_(surface), margin_(margin), reach_(reach),
        points_(points) {}

  void visit(const TriangleMeshShape::Triangle& triangle) {
    pose(triangle);
    float lowest = 1e30F, highest = -1e30F;
    for (int i = 0; i < part_.corners.count; ++i) {
      const float h = t_.height(part_.corners.points[i]);
      lowest = std::min(lowest, h), highest = std::max(highest, h);
    }
    if (lowest > margin_ || highest < 0) return;
    if (triangle.sharp) return visit_sharp(lowest);
    if (lowest >= -kDeepest - margin_) add_face_points();
  }

 private:
  // How deep a part is counts along the axis: the planes of a spike's sides go on far below the
  // corners of what lies on its tip.
  void visit_sharp(float lowest) {
    SurfaceAxis axis;
    if (!find_axis(lowest, axis) || axis.separation < -kDeepest - margin_) return;
    if (dot(axis.normal, t_.normal) > kSameCosine) return add_face_points();
    if (is_exposed(axis.normal)) return add_edge_points(axis);
    const float least = std::min(axis.separation, 0.0F) - kFallback;
    if (!has_point_) {
      axis = {t_.normal, lowest};
      try_axes(axis, true);
      const bool own = dot(axis.normal, t_.normal) > kSameCosine;
      if (!own && axis.separation > least) return add_edge_points(axis);
    }
    if (lowest > least) add_face_points();
  }

  void pose(const TriangleMeshShape::Triangle& triangle) {
    t_.triangle = &triangle;
    t_.normal = Vec3f(surface_.rotation * triangle.normal);
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = surface_.surface->corners()[triangle.corners[k]];
      t_.corners[k] =
          Vec3f(surface_.rotation * (p * surface_.scale) + (surface_.position - centre_));
    }
    for (int k = 0; k < 3; ++k) {
      const Vec3f along = t_.corners[(k + 1) % 3] - t_.corners[k];
      t_.outward[k] = normalized(cross(along, t_.normal));
      // Beyond a concave edge the plane is inside what is solid: who comes fast meets it in good time.
      t_.room[k] = triangle.folds[k] == EdgeConvexity::concave ? kSeam + reach_ : kSeam;
    }
  }

  void add(const Vec3f& on_part, const Vec3f& normal, float separation) {
    points_.push_back({on_part - normal * (0.5F * separation), normal, separation});
  }

  // Against the plane of the triangle: the part's corners over it, and where the face that lies on
  // it goes over a convex edge.
  void add_face_points() {
    for (int i = 0; i < part_.corners.count; ++i) {
      const Vec3f& p = part_.corners.points[i];
      const float h = t_.height(p);
      if (h < margin_ && t_.is_over(p)) add(p, t_.normal, h);
    }
    const TriangleMeshShape::Triangle& triangle = *t_.triangle;
    if (triangle.folds[0] != EdgeConvexity::convex && triangle.folds[1] != EdgeConvexity::convex &&
        triangle.folds[2] != EdgeConvexity::convex) {
      return;
    }
    const auto& face = part_.shape->faces[part_.find_face(-t_.normal)];
    Vec3f p = corner(face, face.count - 1);
    for (int i = 0; i < face.count; ++i) {
      const Vec3f q = corner(face, i);
      for (int k = 0; k < 3; ++k) {
        if (triangle.folds[k] == EdgeConvexity::convex) add_crossing(k, p, q);
      }
      p = q;
    }
  }

  void add_crossing(int edge, const Vec3f& p, const Vec3f& q) {
    const float at_p = t_.beyond(edge, p), at_q = t_.beyond(edge, q);
    if ((at_p > 0) == (at_q > 0)) return;
    const Vec3f x = p + (q - p) * (at_p / (at_p - at_q));
    const float h = t_.height(x);
    if (h < margin_ && t_.is_over(x)) add(x, t_.normal, h);
  }

  Vec3f corner(const ConvexShape::Face& face, int i) const {
    return part_.corners.points[part_.shape->loops[face.first + i]];
  }

  // Along an axis that a convex edge or a peak has for itself.
  void add_edge_points(const SurfaceAxis& axis) {
    const Vec3f side = normalized(t_.corners[1] - t_.corners[0]);
    const Mat3f rotation = Mat3f{{side, cross(t_.normal, side), t_.normal}}.transposed();
    const PosedPart face{&front_face(), {t_.corners, 3}, &rotation};
    Manifold m;
    clip_faces(part_, face, {}, -axis.normal, margin_, m);
    float least = 1e30F;
    for (int i = 0; i < m.count; ++i) {
      least = std::min(least, m.points[i].separation);
      points_.push_back({m.points[i].position, axis.normal, m.points[i].separation});
    }
    if (least <= axis.separation + kAxisAdvantage) return;
    // Edge on edge, or a corner that leads.
    if (has_point_ || find_touch(axis)) points_.push_back({point_, axis.normal, axis.separation});
  }

  // Where the part and the triangle touch first when the part is moved out along the axis. False: nowhere, what leads along the
  // axis is beside the triangle. The ends of an edge lead alike, so a corner that leads may be metres away from where they touch.
  bool find_touch(const SurfaceAxis& axis) {
    GjkCache cache;
    const Vec3f out = axis.normal * (kTouchGap - axis.separation);
    const GjkResult gjk = calc_distance(part_.corners, {t_.corners, 3}, -out, 2 * kTouchGap, cache);
    if (gjk.kind != GjkResult::Kind::separated) return false;
    point_ = gjk.point_a - axis.normal * (0.5F * axis.separation);
    return true;
  }

  // The axis of least overlap or of the distance. False: out of reach, or from behind.
  bool find_axis(float lowest, SurfaceAxis& axis) {
    GjkCache cache;
    const PointSet corners{t_.corners, 3};
    const GjkResult gjk = calc_distance(part_.corners, corners, {}, margin_, cache);
    if (gjk.kind == GjkResult::Kind::beyond_margin) return false;
    has_point_ = gjk.kind == GjkResult::Kind::separated;
    if (has_point_) {
      axis = {-gjk.normal, gjk.distance};
      point_ = (gjk.point_a + gjk.point_b) * 0.5F;
      return dot(axis.normal, t_.normal) > -kLeastCosine;
    }
    axis = {t_.normal, lowest};
    try_axes(axis, false);
    return true;
  }

  bool is_exposed(const Vec3f& normal) const {
    const Vec3 local = surface_.rotation.transposed() * Vec3(normal);
    return surface_.surface->is_exposed(*t_.triangle, local);
  }

  // Those of the part's faces, and of its edges with the triangle's. `exposed`: only those that no
  // neighbour is in the way of.
  void try_axes(SurfaceAxis& best, bool exposed) {
    for (int f = 0; f < int(part_.shape->faces.size()); ++f) {
      try_axis(-part_.face_normal(f), best, exposed);
    }
    for (const auto& edge : part_.shape->edges) {
      const Vec3f along = part_.corners.points[edge.b] - part_.corners.points[edge.a];
      for (int k = 0; k < 3; ++k) {
        try_edges(along, t_.corners[(k + 1) % 3] - t_.corners[k], best, exposed);
      }
    }
  }

  void try_edges(const Vec3f& a, const Vec3f& b, SurfaceAxis& best, bool exposed) {
    const Vec3f n = cross(a, b);
    const float length2 = dot(n, n);
    if (length2 < 1e-6F * dot(a, a) * dot(b, b)) return;  // parallel
    const Vec3f unit = n * (1 / std::sqrt(length2));
    try_axis(dot(unit, t_.normal) < 0 ? -unit : unit, best, exposed);
  }

  void try_axis(const Vec3f& normal, SurfaceAxis& best, bool exposed) {
    if (dot(normal, t_.normal) < kLeastCosine) return;
    const float top = std::max({dot(normal, t_.corners[0]), dot(normal, t_.corners[1]),
                                dot(normal, t_.corners[2])});
    const float s = dot(normal, part_.corners.points[find_support(part_.corners, -normal)]) - top;
    if (s <= best.separation + kAxisAdvantage || (exposed && !is_exposed(normal))) return;
    best = {normal, s};
  }

  const PosedPart& part_;
  const Vec3& centre_;
  const PosedSurface& surface_;
  float margin_, reach_;
  std::vector<SurfaceGap>& points_;
  PosedTriangle t_;
  bool has_point_ = false;
  Vec3f point_;  // midway between the closest points
};

}  // namespace

void find_surface_points(const PosedPart& part, const Vec3& centre, const Aabb& box,
                         const PosedSurface& surface, float margin, float reach,
                         std::vector<SurfaceGap>& points) {
  const Vec3 grow = Vec3{1, 1, 1} * double(margin);
  thread_local std::vector<std::int32_t> near;
  surface.surface->find(surface.to_local({box.min - grow, box.max + grow}), near);
  points.clear();
  SurfaceSearch search(part, centre, surface, margin, reach, points);
  for (const std::int32_t index : near) search.visit(surface.surface->triangles()[index]);
}

}  // namespace rubble
