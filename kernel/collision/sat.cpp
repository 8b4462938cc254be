#include "kernel/collision/sat.h"

#include <algorithm>

namespace rubble {
namespace {

// Edge pairs are worth it only when clearly better than the best face: faces make larger contacts.
constexpr float kEdgeAdvantage = 1e-4F;
// For deeper overlaps, an axis must lead out of the whole piece; unit: m.
constexpr float kDeep = 0.003F;
// An axis leads out of a piece if a point this far beyond the surface is outside; unit: m.
constexpr float kBeyond = 0.005F;
// Two edges separate the parts only if no corner reaches farther over their axis than this; unit: m.
constexpr float kEdgeTolerance = 1e-4F;

float separation_along(const Vec3f& n, const PointSet& a, const PointSet& b, const Vec3f& offset) {
  const Vec3f pa = a.points[find_support(a, n)];
  const Vec3f pb = b.points[find_support(b, -n)] + offset;
  return dot(n, pb - pa);
}

// The best axis of all, and the best of those that lead out of both pieces.
class AxisCandidates {
 public:
  AxisCandidates(const PosedPart& a, const PosedPart& b, const Vec3f& offset)
      : a_(a), b_(b), offset_(offset) {}

  // Nothing is to be gained from an axis with less than this.
  float least(float advantage) const { return free_.separation + advantage; }
  void offer(const SatResult& r, float advantage) {
    if (r.separation > any_.separation + advantage) any_ = r;
    if (r.separation > free_.separation + advantage && leads_out(r)) free_ = r;
  }
  SatResult choose() const {
    const bool deep = any_.separation < -kDeep;
    return deep && free_.separation > kNone ? free_ : any_;
  }

 private:
  static constexpr float kNone = -1e30F;  // no axis yet

  bool leads_out(const SatResult& r) const {
    const Vec3f beyond = r.normal * (kBeyond - 0.5F * r.separation);
    return !a_.is_inside_sibling(r.point + beyond) &&
           !b_.is_inside_sibling(r.point - beyond - offset_);
  }

  const PosedPart &a_, &b_;
  Vec3f offset_;
  SatResult any_{{0, 0, 1}, kNone, {}}, free_{{0, 0, 1}, kNone, {}};
};

void try_faces(const PosedPart& a, const PosedPart& b, const Vec3f& offset, float sign,
               AxisCandidates& best) {
  const PosedPart& owner = sign > 0 ? a : b;
  for (int f = 0; f < int(owner.shape->faces.size()); ++f) {
    const Vec3f n = owner.face_normal(f) * sign;
    const float s = separation_along(n, a.corners, b.corners, offset);
    if (s <= best.least(0)) continue;
    // The deepest corner of the other part, halfway back to the face.
    const Vec3f corner = sign > 0 ? b.corners.points[find_support(b.corners, -n)] + offset
                                  : a.corners.points[find_support(a.corners, n)];
    best.offer({n, s, corner - n * (sign * 0.5F * s)}, 0);
  }
}

// Two edges make a face of the Minkowski difference when their arcs on the Gauss map cross.
bool arcs_cross(const Vec3f& a, const Vec3f& b, const Vec3f& b_x_a, const Vec3f& c, const Vec3f& d,
                const Vec3f& d_x_c) {
  const float cba = dot(c, b_x_a), dba = dot(d, b_x_a);
  const float adc = dot(a, d_x_c), bdc = dot(b, d_x_c);
  return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

// Midway between the closest points of two lines that are not parallel.
Vec3f crossing(const Vec3f& p, const Vec3f& d, const Vec3f& q, const Vec3f& e) {
  const Vec3f r = q - p;
  const float dd = dot(d, d), de = dot(d, e), ee = dot(e, e), dr = dot(d, r), er = dot(e, r);
  const float scale = 1 / (dd * ee - de * de);
  const float t = (dr * ee - de * er) * scale, u = (dr * de - dd * er) * scale;
  return (p + d * t + q + e * u) * 0.5F;
}

void try_edges(const PosedPart& a, const PosedPart& b, const Vec3f& offset, AxisCandidates& best) {
  for (const auto& ea : a.shape->edges) {
    const Vec3f na = a.face_normal(ea.left_face), ma = a.face_normal(ea.right_face);
    const Vec3f da = a.corners.points[ea.b] - a.corners.points[ea.a];
    const Vec3f m_x_n = cross(ma, na);
    for (const auto& eb : b.shape->edges) {
      const Vec3f nb = -b.face_normal(eb.left_face), mb = -b.face_normal(eb.right_face);
      if (!arcs_cross(na, ma, m_x_n, nb, mb, cross(mb, nb))) continue;
      const Vec3f db = b.corners.points[eb.b] - b.corners.points[eb.a];
      Vec3f n = cross(da, db);
      const float length2 = dot(n, n);
      if (length2 < 1e-6F * dot(da, da) * dot(db, db)) continue;  // parallel
      n *= 1 / std::sqrt(length2);
      if (dot(n, na + ma) < 0) n = -n;
      const Vec3f from_a = a.corners.points[ea.a], from_b = b.corners.points[eb.a] + offset;
      const float s = dot(n, from_b - from_a);
      if (s <= best.least(kEdgeAdvantage)) continue;
      // Where faces are nearly level with each other, rounding lets arcs cross that do not.
      if (separation_along(n, a.corners, b.corners, offset) < s - kEdgeTolerance) continue;
      best.offer({n, s, crossing(from_a, da, from_b, db)}, kEdgeAdvantage);
    }
  }
}

}  // namespace

int PosedPart::find_face(const Vec3f& direction) const {
  const Vec3f local = rotation->transposed() * direction;
  int best = 0;
  float best_dot = -2;
  for (int f = 0; f < int(shape->faces.size()); ++f) {
    const float d = dot(shape->faces[f].normal, local);
    if (d > best_dot) best_dot = d, best = f;
  }
  return best;
}

bool PosedPart::is_inside_sibling(const Vec3f& point) const {
  if (piece == nullptr) return false;
  const Vec3f local = rotation->transposed() * point * (1 / scale);
  for (const ConvexShape& part : piece->parts) {
    if (&part == shape) continue;
    const bool inside = std::all_of(part.faces.begin(), part.faces.end(), [&](const auto& face) {
      return dot(face.normal, local - part.corners[part.loops[face.first]]) < 0;
    });
    if (inside) return true;
  }
  return false;
}

SatResult find_separating_axis(const PosedPart& a, const PosedPart& b, const Vec3f& offset) {
  AxisCandidates best(a, b, offset);
  try_faces(a, b, offset, 1, best);
  try_faces(a, b, offset, -1, best);
  try_edges(a, b, offset, best);
  return best.choose();
}

}  // namespace rubble
