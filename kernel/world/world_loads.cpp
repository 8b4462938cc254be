// What contacts and ties of a laid building carry, put back from the state that it was saved as.
#include <algorithm>
#include <utility>

#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// A load goes to the nearest point of the contacts of its two pieces. Where the load is square to the normal of the contact, the
// point counts as so much farther away. unit: m
constexpr double kAskew = 0.05;

using PieceNumbers = std::pair<std::int32_t, std::int32_t>;  // ascending; the ground is -1

struct LoadedPoint {
  PieceNumbers pieces;
  std::int32_t contact = 0, point = 0;
  Vec3 at;       // in the world; unit: m
  Vec3 normal;   // out of the lower piece
  double sign = 1;  // of the contact's own normal
};

PieceNumbers ordered(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

void World::Impl::put_loads(const BuildingState& building) {
  const double per_substep = settings.options.step / settings.solver.substeps;
  const auto piece_of = [this](std::int32_t collider, std::int32_t body) {
    return collider >= 0 ? data.colliders[std::size_t(collider)].piece : body;
  };
  std::vector<LoadedPoint> points;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    const Pair& pair = data.pairs[i];
    Contact& contact = data.contacts[i];
    if (contact.count == 0) continue;
    contact.friction_impulse = {};
    const std::int32_t a = piece_of(pair.collider_a, pair.body_a), b = piece_of(pair.collider_b, pair.body_b);
    const Vec3 centre = data.bodies[std::size_t(pair.body_a)].world_from_com.translation;
    for (int k = 0; k < contact.count; ++k) {
      contact.points[k].normal_impulse = 0;
      const double sign = a < b ? 1 : -1;
      points.push_back({ordered(a, b), std::int32_t(i), k, centre + Vec3(contact.points[k].from_a),
                        Vec3(contact.normal) * sign, sign});
    }
  }
  const auto by_pieces = [](const LoadedPoint& p, const LoadedPoint& q) { return p.pieces < q.pieces; };
  std::stable_sort(points.begin(), points.end(), by_pieces);
  for (const ContactLoad& load : building.loads) {
    LoadedPoint key;
    key.pieces = ordered(load.piece, load.other);
    const auto range = std::equal_range(points.begin(), points.end(), key, by_pieces);
    // On the higher piece.
    const Vec3 force = Vec3(load.force) * (load.piece > load.other ? 1.0 : -1.0);
    const double strength = norm(force);
    const LoadedPoint* best = nullptr;
    double nearest = 0;
    for (auto p = range.first; p != range.second; ++p) {
      const double cosine = strength > 0 ? dot(p->normal, force) / strength : 1;
      const double away = distance(p->at, Vec3(load.point)) + kAskew * (1 - cosine);
      if (!best || away < nearest) best = &*p, nearest = away;
    }
    if (!best) continue;
    Contact& contact = data.contacts[std::size_t(best->contact)];
    const double pressed = std::max(0.0, dot(best->normal, force));
    contact.points[best->point].normal_impulse += float(pressed * per_substep);
    contact.friction_impulse += Vec3f((force - best->normal * dot(best->normal, force)) * (best->sign * per_substep));
  }
  for (std::size_t i = 0; i < std::min(data.ties.size(), building.tie_forces.size()); ++i)
    data.ties[i].contact.points[0].normal_impulse = float(double(building.tie_forces[i]) * per_substep);
}

}  // namespace rubble
