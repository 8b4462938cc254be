// Where a ray meets the triangles of a block, in lanes of triangles: see triangle_block.h.
//
// A ray passes through a triangle when it passes all three edges on the same side (Plücker coordinates). Neighbours
// share the bits of an edge with opposite signs, so no ray slips through between them. A distance is clamped to where the
// ray is within the box of the triangle: at grazing angles rounding could otherwise put it outside, where the order in
// which blocks are visited would matter.
#include "render/geometry/triangle_block.h"
#include "render/geometry/wide.h"

namespace rubble::RUBBLE_ISA {
namespace {

static_assert(TriangleBlock::kSize % kWidth == 0);
constexpr float kEdgeTolerance = 1.1920929e-7f;  // of the sum of the three edges

struct Lanes3 {
  Real x, y, z;
};

RUBBLE_INLINE Real load(const float* from) {
  Real out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
RUBBLE_INLINE Lanes3 load(const float (&corner)[3][TriangleBlock::kSize], int first) {
  return {load(corner[0] + first), load(corner[1] + first), load(corner[2] + first)};
}
RUBBLE_INLINE Lanes3 all(const Vec3f& v) { return {real(v.x), real(v.y), real(v.z)}; }
RUBBLE_INLINE Lanes3 operator-(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
RUBBLE_INLINE Lanes3 operator+(const Lanes3& a, const Lanes3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
RUBBLE_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
RUBBLE_INLINE Real dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// From where to where a ray is between the two planes that bound three corners along an axis.
RUBBLE_INLINE void clip(Real a, Real b, Real c, float margin, float from, float inverse, Real& enter, Real& leave) {
  const Real low = (min(min(a, b), c) - margin - from) * inverse, high = (max(max(a, b), c) + margin - from) * inverse;
  enter = max(enter, min(low, high)), leave = min(leave, max(low, high));
}

RUBBLE_INLINE float margin_of(const TriangleBlock& block, float reach) {
  Real far = real(0);
  for (const auto& corner : block.corners)
    for (const auto& axis : corner)
      for (int first = 0; first < TriangleBlock::kSize; first += kWidth) far = max(far, abs(load(axis + first)));
  float farthest = 0;
  for (int i = 0; i < kWidth; ++i) farthest = farthest < far[i] ? far[i] : farthest;
  return TriangleBlock::margin(reach, farthest);
}

struct Meeting {
  Mask met;
  Real distance, u, v;
  Lanes3 normal;
  Real facing;  // normal times direction
};

RUBBLE_INLINE Meeting meet(const TriangleBlock& block, const BlockRay& ray, int first) {
  const Lanes3 a = load(block.corners[0], first), b = load(block.corners[1], first), c = load(block.corners[2], first);
  const Lanes3 from = all(ray.from), direction = all(ray.direction);
  const Lanes3 ra = a - from, rb = b - from, rc = c - from;
  const Lanes3 ca = c - a, ab = a - b, bc = b - c;
  const Real u = dot(cross(ca, rc + ra), direction), v = dot(cross(ab, ra + rb), direction),
             w = dot(cross(bc, rb + rc), direction);
  const Real sum = u + v + w, tolerance = abs(sum) * kEdgeTolerance;
  Meeting out;
  out.met = (min(min(u, v), w) >= -tolerance) | (max(max(u, v), w) <= tolerance);
  if (!any(out.met)) return out;
  out.normal = cross(ab, ca);  // (a - b) x (c - a) = (b - a) x (c - a), turned
  out.normal = {-out.normal.x, -out.normal.y, -out.normal.z};
  out.facing = dot(out.normal, direction);
  out.met &= (out.facing != real(0)) & (sum != real(0));
  const float margin = margin_of(block, ray.reach);
  Real enter = real(-3e38f), leave = real(3e38f);
  clip(a.x, b.x, c.x, margin, ray.from.x, ray.inverse.x, enter, leave);
  clip(a.y, b.y, c.y, margin, ray.from.y, ray.inverse.y, enter, leave);
  clip(a.z, b.z, c.z, margin, ray.from.z, ray.inverse.z, enter, leave);
  out.met &= enter <= leave;
  out.distance = min(max(dot(out.normal, ra) / out.facing, enter), leave);
  out.met &= out.distance >= real(ray.nearest);
  out.u = clamp(u / sum, 0.0f, 1.0f), out.v = clamp(v / sum, 0.0f, 1.0f);
  return out;
}

bool meet_block(const TriangleBlock& block, const BlockRay& ray, BlockHit& hit) {
  bool nearer = false;
  for (int first = 0; first < TriangleBlock::kSize; first += kWidth) {
    Meeting m = meet(block, ray, first);
    if (!any(m.met)) continue;
    m.met &= m.distance <= real(hit.distance);
    if (!any(m.met)) continue;
    for (int i = 0; i < kWidth; ++i) {
      if (!m.met[i]) continue;
      const std::uint32_t triangle = block.ids[first + i] + ray.first_id;
      if (m.distance[i] > hit.distance || (m.distance[i] == hit.distance && triangle >= hit.triangle)) continue;
      hit = {m.distance[i], triangle, m.u[i], m.v[i], {m.normal.x[i], m.normal.y[i], m.normal.z[i]}, m.facing[i] > 0};
      nearer = true;
    }
  }
  return nearer;
}

bool block_hides(const TriangleBlock& block, const BlockRay& ray, float farthest) {
  for (int first = 0; first < TriangleBlock::kSize; first += kWidth) {
    const Meeting m = meet(block, ray, first);
    if (any(m.met) && any(m.met & (m.distance <= real(farthest)))) return true;
  }
  return false;
}

}  // namespace

extern const BlockFunctions kBlockFunctions;
const BlockFunctions kBlockFunctions = {RUBBLE_NAME_OF_ISA, meet_block, block_hides};

}  // namespace rubble::RUBBLE_ISA
