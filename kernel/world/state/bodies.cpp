#include "kernel/world/state/bodies.h"

#include <algorithm>

#include "kernel/base/inertia.h"
#include "kernel/solver/wide.h"

namespace rubble {
namespace {

Quad quad_of(const Vec3f& v) { return Quad{v.x, v.y, v.z, 0}; }

}  // namespace

void Bodies::weigh(Body& body) const {
  const PieceType& type = types_.pieces[std::size_t(body.type)];
  const double s3 = body.scale * body.scale * body.scale;
  body.mass = type.density * body.shape->volume.volume * s3;
  body.inertia = body.shape->volume.inertia * (type.density * s3 * body.scale * body.scale);
  body.inverse_mass = float(1 / body.mass);
  body.inverse_inertia_local = to_float(inverse_of(body.inertia));
}

void Bodies::weigh(Body& body, const RigidGroup& group) {
  double mass = 0;
  Vec3 centre;
  for (const std::int32_t member : group.members) {
    const Body& piece = data_.bodies[member];
    const double m = types_.pieces[piece.type].density * piece.shape->volume.volume;
    mass += m;
    centre += (piece.origin_in_group + piece.shape->volume.centre_of_mass) * m;
  }
  centre *= 1 / mass;
  Mat3 inertia{};
  for (const std::int32_t member : group.members) {
    Body& piece = data_.bodies[member];
    piece.origin_in_group -= centre;
    const VolumeProperties& volume = piece.shape->volume;
    const double density = types_.pieces[piece.type].density;
    inertia = inertia + volume.inertia * density;
    add_offset(inertia, density * volume.volume, piece.origin_in_group + volume.centre_of_mass);
  }
  body.com_in_type = -body.origin_in_group;
  body.world_from_com.translation += body.world_from_com.rotation.rotate(centre);
  body.mass = mass;
  body.inertia = inertia;
}

void Bodies::add(const NewPiece& piece, FreeBody* free) {
  const Placement& at = piece.placement;
  Body body;
  body.type = at.kind.index;
  body.layer = piece.layer;
  body.scale = at.scale;
  body.shape = &types_.shapes[std::size_t(at.kind.index)];
  body.com_in_type = body.shape->volume.centre_of_mass * at.scale;
  body.radius = body.shape->radius * float(at.scale);
  body.world_from_com = {normalized(at.world_from_body.rotation), at.world_from_body * body.com_in_type};
  if (!at.fixed) {
    weigh(body);
    body.awake = true;
    body.linear = Vec3f(piece.linear_velocity);
    body.angular = Vec3f(piece.angular_velocity);
    body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
    *free = {body.mass, body.inertia, body.world_from_com, piece.linear_velocity, piece.angular_velocity};
  }
  body.first_collider = std::int32_t(data_.colliders.size());
  body.collider_count = std::int32_t(body.shape->parts.size());
  for (int part = 0; part < body.collider_count; ++part) {
    Collider collider;
    collider.body = collider.piece = std::int32_t(data_.bodies.size());
    collider.part = part;
    collider.first_corner = std::int32_t(data_.corners.size());
    data_.corners.resize(data_.corners.size() + body.shape->parts[part].corners.size());
    data_.colliders.push_back(collider);
    data_.broad.add();
  }
  data_.wake_next.push_back(0);
  data_.bodies.push_back(body);
}

void Bodies::add_to_blocks(int first, const std::vector<FreeBody>& free) {
  // Neighbours in height land and fall asleep together, so they share a block.
  std::vector<std::int32_t> order;
  for (int i = first; i < int(data_.bodies.size()); ++i) {
    if (data_.bodies[i].mass > 0 && data_.bodies[i].tree < 0) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return data_.bodies[a].world_from_com.translation.z < data_.bodies[b].world_from_com.translation.z;
  });
  std::vector<FreeBody> sorted;
  for (int body : order) sorted.push_back(free[std::size_t(body - first)]);
  int mobile = blocks_.add(sorted);
  for (int body : order) data_.bodies[body].free_index = mobile++;
}

void Bodies::mirror(Body& body) {
  body.world_from_com = blocks_.world_from_com(body.free_index);
  body.linear = Vec3f(blocks_.linear_velocity(body.free_index));
  body.angular = Vec3f(blocks_.angular_velocity(body.free_index));
}

void Bodies::refresh(Body& body) {
  if (body.group >= 0) return refresh_group(body);
  body.rotation = to_float(body.world_from_com.rotation.matrix());
  if (body.mass > 0) {
    body.inverse_inertia = body.rotation * body.inverse_inertia_local * body.rotation.transposed();
  }
  const float scale = float(body.scale);
  const Mat3f scaled = body.rotation * scale;
  const Quad columns[3] = {quad_of(scaled.column(0)), quad_of(scaled.column(1)), quad_of(scaled.column(2))};
  const Vec3& centre = body.world_from_com.translation;
  for (int i = 0; i < body.collider_count; ++i) {
    Collider& collider = data_.colliders[body.first_collider + i];
    const auto& corners = body.shape->parts[collider.part].corners;
    Quad low = make_quad(1e30F), high = -low;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      // All three coordinates at once, each by the operations of scaled * corner.
      const Vec3f& c = corners[k];
      const Quad p = columns[0] * make_quad(c.x) + columns[1] * make_quad(c.y) + columns[2] * make_quad(c.z);
      data_.corners[collider.first_corner + k] = {p[0], p[1], p[2]};
      low = low < p ? low : p;
      high = high > p ? high : p;
    }
    collider.box = {centre + Vec3(Vec3f{low[0], low[1], low[2]}),
                    centre + Vec3(Vec3f{high[0], high[1], high[2]})};
  }
}

// Corners from the group's centre of mass, and boxes.
void Bodies::refresh_group(Body& body) {
  body.rotation = to_float(body.world_from_com.rotation.matrix());
  if (body.mass > 0) {
    body.inverse_inertia = body.rotation * body.inverse_inertia_local * body.rotation.transposed();
  }
  const Vec3& centre = body.world_from_com.translation;
  for (const std::int32_t member : data_.groups[body.group].members) {
    const Body& piece = data_.bodies[member];
    const Vec3f offset(piece.origin_in_group + piece.shape->volume.centre_of_mass);
    for (int i = 0; i < piece.collider_count; ++i) {
      Collider& collider = data_.colliders[piece.first_collider + i];
      const auto& corners = piece.shape->parts[collider.part].corners;
      Aabb box;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3f p = body.rotation * (corners[k] + offset);
        data_.corners[collider.first_corner + k] = p;
        box.include(centre + Vec3(p));
      }
      collider.box = box;
    }
  }
}

Body& Bodies::acting(int piece) {
  Body& body = data_.bodies[piece];
  return body.lead >= 0 ? data_.bodies[body.lead] : body;
}

const Body& Bodies::acting(int piece) const {
  const Body& body = data_.bodies[piece];
  return body.lead >= 0 ? data_.bodies[body.lead] : body;
}

const Vec3f& Bodies::reach_of(const Body& body) const {
  return body.group >= 0 ? data_.groups[body.group].reach : body.shape->reach;
}

double Bodies::friction_of(std::int32_t collider) const {
  return types_.pieces[data_.bodies[data_.colliders[collider].piece].type].friction;
}

Vec3 Bodies::linear_velocity(const Body& body) const {
  if (body.tree >= 0) return data_.trees[body.tree].links[body.link].linear;
  return body.free_index >= 0 ? blocks_.linear_velocity(body.free_index) : Vec3{};
}

Vec3 Bodies::angular_velocity(const Body& body) const {
  if (body.tree >= 0) return data_.trees[body.tree].links[body.link].angular;
  return body.free_index >= 0 ? blocks_.angular_velocity(body.free_index) : Vec3{};
}

PosedBody Bodies::posed(const Collider& collider) const {
  const Body& body = data_.bodies[collider.body];
  const ConvexShape& shape = data_.bodies[collider.piece].shape->parts[collider.part];
  PosedBody result;
  result.part = {&shape,
                 {&data_.corners[collider.first_corner], int(shape.corners.size())},
                 &body.rotation,
                 body.collider_count > 1 ? body.shape : nullptr,
                 float(body.scale)};
  result.centre = body.world_from_com.translation;
  result.linear = body.linear;
  result.angular = body.angular;
  return result;
}

std::vector<PosedPart> Bodies::posed_parts(const Body& body) const {
  std::vector<PosedPart> parts;
  for (int i = 0; i < body.collider_count; ++i) {
    parts.push_back(posed(data_.colliders[std::size_t(body.first_collider + i)]).part);
  }
  return parts;
}

}  // namespace rubble
