#include "kernel/collision/surface_contact.h"

#include <algorithm>

#include "kernel/collision/manifold.h"
#include "kernel/collision/rolling.h"
#include "kernel/collision/surface_points.h"

namespace rubble {
namespace {

// Points whose normals differ by less than 10 degrees make one contact.
constexpr float kMergeCosine = 0.985F;
// The normals of points up to this separation count, the more the nearer they are; unit: m.
constexpr float kWeighted = 0.005F;
// Points of one contact nearer to each other than this are one; unit: m.
constexpr float kSamePoint = 1e-3F;
// A slot is kept for a contact whose normal turned by less than 25 degrees.
constexpr float kKeepSlotCosine = 0.906F;

struct Cluster {
  Vec3f first, sum;  // normals
  Manifold manifold;

  Vec3f normal() const { return dot(sum, sum) > 0 ? normalized(sum) : first; }
};

bool is_known(const Manifold& m, const Vec3f& position) {
  for (int i = 0; i < m.count; ++i) {
    const Vec3f d = m.points[i].position - position;
    if (dot(d, d) < kSamePoint * kSamePoint) return true;
  }
  return false;
}

void add(Cluster& cluster, const SurfaceGap& point, float predicted) {
  Manifold& m = cluster.manifold;
  if (m.count == Manifold::kMaxClipped || is_known(m, point.position)) return;
  m.points[m.count++] = {point.position, point.separation, predicted, -1};
  cluster.sum += point.normal * std::max(0.0F, kWeighted - point.separation);
}

struct Predicted {
  float when = 0;  // separation at the end of the step, if nothing stops it
  std::int32_t point = 0;
};

// Deepest first: what is left over when the slots are full matters least.
int make_clusters(const std::vector<SurfaceGap>& points, const PosedBody& a, float step,
                  Cluster (&clusters)[kSurfaceSlots]) {
  thread_local std::vector<Predicted> order;
  order.clear();
  const bool round = !points.empty() && rolls(a, points[0].normal, step);
  const Vec3f angular = round ? Vec3f{} : a.angular;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfaceGap& p = points[i];
    const float speed = dot(p.normal, a.linear + cross(angular, p.position));
    const float when = p.separation + step * speed;
    if (std::min(when, p.separation) < kPointMargin) order.push_back({when, std::int32_t(i)});
  }
  std::sort(order.begin(), order.end(), [](const Predicted& p, const Predicted& q) {
    return p.when != q.when ? p.when < q.when : p.point < q.point;
  });
  int count = 0;
  for (const Predicted& next : order) {
    const SurfaceGap& p = points[next.point];
    int cluster = 0;
    while (cluster < count && dot(clusters[cluster].first, p.normal) < kMergeCosine) ++cluster;
    if (cluster == kSurfaceSlots) continue;
    if (cluster == count) clusters[count++].first = p.normal;
    add(clusters[cluster], p, next.when);
  }
  return count;
}

// The slot with the nearest normal, else an empty one, else any that is left.
int find_slot(Contact* const (&slots)[kSurfaceSlots], const bool (&taken)[kSurfaceSlots],
              const Vec3f& normal, bool matching_only) {
  int best = -1;
  float best_cosine = kKeepSlotCosine;
  for (int i = 0; i < kSurfaceSlots; ++i) {
    const float cosine = dot(slots[i]->normal, normal);
    if (taken[i] || slots[i]->count == 0 || cosine <= best_cosine) continue;
    best = i, best_cosine = cosine;
  }
  if (best >= 0 || matching_only) return best;
  for (int i = 0; i < kSurfaceSlots; ++i) {
    if (!taken[i] && (best < 0 || (slots[best]->count > 0 && slots[i]->count == 0))) best = i;
  }
  return best;
}

}  // namespace

PosedSurface::PosedSurface(const Body& body)
    : surface(body.shape->surface.get()),
      rotation(body.world_from_com.rotation.matrix()),
      position(body.world_from_com.translation),
      scale(body.scale) {}

Aabb PosedSurface::to_local(const Aabb& world_box) const {
  const Vec3 middle = (world_box.min + world_box.max) * 0.5, half = world_box.max - middle;
  const Mat3 local_from_world = rotation.transposed();
  const Vec3 c = local_from_world * (middle - position) * (1 / scale);
  Vec3 r;
  for (int i = 0; i < 3; ++i) {
    const Vec3& row = local_from_world.rows[i];
    r[i] = (std::abs(row.x) * half.x + std::abs(row.y) * half.y + std::abs(row.z) * half.z) / scale;
  }
  return {c - r, c + r};
}

void update_surface_contacts(Contact* const (&slots)[kSurfaceSlots], const PosedBody& a,
                             const Aabb& box, const PosedSurface& b, float margin,
                             const NarrowSettings& settings) {
  thread_local std::vector<SurfaceGap> points;
  find_surface_points(a.part, a.centre, box, b, margin, margin - settings.margin, points);
  Cluster clusters[kSurfaceSlots];
  const int count = make_clusters(points, a, settings.step, clusters);
  bool taken[kSurfaceSlots] = {};
  int slot_of[kSurfaceSlots];
  for (const bool matching_only : {true, false}) {
    for (int i = 0; i < count; ++i) {
      if (!matching_only && slot_of[i] >= 0) continue;
      slot_of[i] = find_slot(slots, taken, -clusters[i].normal(), matching_only);
      if (slot_of[i] >= 0) taken[slot_of[i]] = true;
    }
  }
  for (int i = 0; i < kSurfaceSlots; ++i) {
    if (!taken[i]) clear_points(*slots[i]);
  }
  for (int i = 0; i < count; ++i) {
    const Vec3f normal = -clusters[i].normal();
    Contact& contact = *slots[slot_of[i]];
    contact.rolls_a = rolls(a, normal, settings.step);
    if (contact.rolls_a) carry_below_axis(clusters[i].manifold, normal, a.angular, {});
    store_points(contact, clusters[i].manifold, normal, a);
  }
}

}  // namespace rubble
