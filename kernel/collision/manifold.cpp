#include "kernel/collision/manifold.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rubble {
namespace {

// A face steeper than this against the normal is no reference for clipping.
constexpr float kMinimumCosine = 0.9F;
// Prefer A's face as reference unless B's is clearly better, so that the choice does not flicker.
constexpr float kReferencePreference = 1e-3F;

// Points that will be closer than this count as touching; unit: m.
constexpr float kTouchingDistance = 0.0015F;

// A point that is known counts as so much deeper, and as so much farther out, when points are chosen; unit: m, 1
constexpr float kKnownDepth = 0.0005F, kKnownReach = 1.05F;

struct ClipPolygon {
  Vec3f points[Manifold::kMaxClipped];
  int count = 0;
  void add(const Vec3f& p) {
    if (count < Manifold::kMaxClipped) points[count++] = p;
  }
};

void clip(const ClipPolygon& in, const Vec3f& plane_point, const Vec3f& outward, ClipPolygon& out) {
  out.count = 0;
  if (in.count == 0) return;
  Vec3f last = in.points[in.count - 1];
  float last_side = dot(outward, last - plane_point);
  for (int i = 0; i < in.count; ++i) {
    const Vec3f p = in.points[i];
    const float side = dot(outward, p - plane_point);
    if ((side > 0) != (last_side > 0)) out.add(last + (p - last) * (last_side / (last_side - side)));
    if (side <= 0) out.add(p);
    last = p;
    last_side = side;
  }
}

// Faces of more corners are clipped as if they had this many, evenly chosen: the ends of fine drums.
constexpr int kMostCorners = Manifold::kMaxClipped / 2;

int count_corners(const ConvexShape::Face& face) {
  return std::min(int(face.count), kMostCorners);
}

Vec3f corner(const PosedPart& part, const ConvexShape::Face& face, int i) {
  const int of_face = face.count <= kMostCorners ? i : i * face.count / kMostCorners;
  return part.corners.points[part.shape->loops[face.first + of_face]];
}

}  // namespace

void clip_faces(const PosedPart& a, const PosedPart& b, const Vec3f& offset, const Vec3f& normal,
                float margin, Manifold& manifold) {
  const int face_a = a.find_face(normal), face_b = b.find_face(-normal);
  const float cosine_a = dot(a.face_normal(face_a), normal);
  const float cosine_b = -dot(b.face_normal(face_b), normal);
  const bool flip = cosine_b > cosine_a + kReferencePreference;
  if ((flip ? cosine_b : cosine_a) < kMinimumCosine) return;

  const PosedPart& ref = flip ? b : a;
  const PosedPart& inc = flip ? a : b;
  const auto& ref_face = ref.shape->faces[flip ? face_b : face_a];
  const auto& inc_face = inc.shape->faces[flip ? face_a : face_b];
  const Vec3f ref_offset = flip ? offset : Vec3f{}, inc_offset = flip ? Vec3f{} : offset;
  const Vec3f n = flip ? -normal : normal;  // away from the reference
  const Vec3f ref_normal = ref.face_normal(flip ? face_b : face_a);

  thread_local ClipPolygon buffers[2];  // made once: to clear them takes as long as to clip
  ClipPolygon *in = &buffers[0], *out = &buffers[1];
  in->count = 0;
  for (int i = 0; i < count_corners(inc_face); ++i) {
    in->add(corner(inc, inc_face, i) + inc_offset);
  }
  Vec3f p = corner(ref, ref_face, count_corners(ref_face) - 1) + ref_offset;
  for (int i = 0; i < count_corners(ref_face) && in->count > 0; ++i) {
    const Vec3f q = corner(ref, ref_face, i) + ref_offset;
    clip(*in, p, cross(q - p, n), *out);
    std::swap(in, out);
    p = q;
  }
  const float per_cosine = 1 / dot(ref_normal, n);
  for (int i = 0; i < in->count; ++i) {
    const float s = dot(ref_normal, in->points[i] - p) * per_cosine;
    if (s >= margin) continue;
    manifold.points[manifold.count++] = {in->points[i] - n * (0.5F * s), s, s, -1};
  }
}

void reduce(Manifold& m, const Vec3f& normal, int most) {
  if (m.count <= most) return;
  std::stable_sort(m.points, m.points + m.count, [](const ManifoldPoint& p, const ManifoldPoint& q) {
    return p.predicted < q.predicted;
  });
  int touching = 0;
  while (touching < m.count && m.points[touching].predicted < kTouchingDistance) ++touching;
  if (touching <= most) {
    m.count = most;
    return;
  }
  m.count = touching;
  const auto move_best_to = [&m](int slot, auto&& score) {
    int best = slot;
    float best_score = score(m.points[slot]);
    for (int i = slot + 1; i < m.count; ++i) {
      const float s = score(m.points[i]);
      if (s > best_score) best_score = s, best = i;
    }
    std::swap(m.points[slot], m.points[best]);
  };
  const auto depth = [](const ManifoldPoint& p) { return (p.known ? kKnownDepth : 0) - p.predicted; };
  const auto reach = [](const ManifoldPoint& p, float distance) { return p.known ? kKnownReach * distance : distance; };
  move_best_to(0, depth);
  const Vec3f p0 = m.points[0].position;
  move_best_to(1, [&](const ManifoldPoint& p) { return reach(p, norm(p.position - p0)); });
  const Vec3f side = cross(m.points[1].position - p0, normal);
  move_best_to(2, [&](const ManifoldPoint& p) { return reach(p, std::abs(dot(side, p.position - p0))); });
  // On the other side of the first edge than the third point.
  const float sign = dot(side, m.points[2].position - p0) > 0 ? -1.0F : 1.0F;
  move_best_to(3, [&](const ManifoldPoint& p) { return reach(p, sign * dot(side, p.position - p0)); });
  for (int slot = 4; slot < most; ++slot) move_best_to(slot, depth);
  m.count = most;
}

}  // namespace rubble
