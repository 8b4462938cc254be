#include "kernel/world/world.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/inertia.h"
#include "kernel/multibody/springs/tree_springs.h"
#include "kernel/solver/wide.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

Quad quad_of(const Vec3f& v) { return Quad{v.x, v.y, v.z, 0}; }

void check_movable(const NewPiece& piece, const std::vector<PieceType>& types, int placeable,
                   int index) {
  const int type = piece.placement.type;
  if (piece.placement.fixed || type >= placeable || !types[std::size_t(type)].surface) return;
  Diagnostic d;
  d.key = "pieces[" + std::to_string(index) + "].fixed";
  d.message = "a surface cannot move";
  d.expected = "true";
  d.found = "false";
  throw InputError(d);
}

void check(const NewPiece& piece, int types, int index) {
  Diagnostic d;
  d.key = "pieces[" + std::to_string(index) + "]";
  if (piece.placement.type < 0 || piece.placement.type >= types) {
    d.key += ".type";
    d.message = "no such type";
    d.expected = "0 to " + std::to_string(types - 1);
    d.found = std::to_string(piece.placement.type);
    throw InputError(d);
  }
  if (!(piece.placement.scale >= 0.01 && piece.placement.scale <= 100)) {
    d.key += ".scale";
    d.message = "out of range";
    d.expected = "0.01 to 100";
    d.found = std::to_string(piece.placement.scale);
    throw InputError(d);
  }
}

// What hangs by a joint rests when it has stayed in place for this long; unit: s.
constexpr double kHangingTime = 0.15;

}  // namespace

World::Impl::Impl(std::vector<PieceType> piece_types, const WorldOptions& world_options,
                  std::vector<AssemblyType> assembly_types)
    : types(std::move(piece_types)),
      placeable_types(int(types.size())),
      assemblies(std::move(assembly_types)),
      options(world_options),
      pool(world_options.threads) {
  solver_settings.step = narrow_settings.step = float(options.step);
  solver_settings.gravity = float(options.gravity);
  for (std::size_t i = 0; i < types.size(); ++i) {
    shapes.push_back(compile_shape(types[i], "types[" + std::to_string(i) + "]"));
  }
  for (std::size_t i = 0; i < assemblies.size(); ++i) {
    const std::string key = "assemblies[" + std::to_string(i) + "]";
    validate(assemblies[i], int(types.size()), key);
    for (const AssemblyLink& link : assemblies[i].links) {
      if (!types[link.type].surface) continue;
      throw InputError({"", 0, key, "a link is a surface, which cannot move", "", "", ""});
    }
  }
}

void World::Impl::weigh(Body& body) const {
  const PieceType& type = types[std::size_t(body.type)];
  const double s3 = body.scale * body.scale * body.scale;
  body.mass = type.density * body.shape->volume.volume * s3;
  body.inertia = body.shape->volume.inertia * (type.density * s3 * body.scale * body.scale);
  body.inverse_mass = float(1 / body.mass);
  body.inverse_inertia_local = to_float(inverse_of(body.inertia));
}

void World::Impl::add_body(const NewPiece& piece, FreeBody* free) {
  const Placement& at = piece.placement;
  Body body;
  body.type = at.type;
  body.layer = piece.layer;
  body.scale = at.scale;
  body.shape = &shapes[at.type];
  body.com_in_type = body.shape->volume.centre_of_mass * at.scale;
  body.radius = body.shape->radius * float(at.scale);
  body.world_from_com = {normalized(at.world_from_body.rotation),
                         at.world_from_body * body.com_in_type};
  if (!at.fixed) {
    weigh(body);
    body.awake = true;
    body.linear = Vec3f(piece.linear_velocity);
    body.angular = Vec3f(piece.angular_velocity);
    body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
    *free = {body.mass, body.inertia, body.world_from_com, piece.linear_velocity,
             piece.angular_velocity};
  }
  body.first_collider = std::int32_t(data.colliders.size());
  body.collider_count = std::int32_t(body.shape->parts.size());
  for (int part = 0; part < body.collider_count; ++part) {
    Collider collider;
    collider.body = collider.piece = std::int32_t(data.bodies.size());
    collider.part = part;
    collider.first_corner = std::int32_t(data.corners.size());
    data.corners.resize(data.corners.size() + body.shape->parts[part].corners.size());
    data.colliders.push_back(collider);
    data.broad.add();
  }
  data.wake_next.push_back(0);
  data.bodies.push_back(body);
}

void World::Impl::mirror(Body& body) {
  body.world_from_com = blocks.world_from_com(body.simbody_index);
  body.linear = Vec3f(blocks.linear_velocity(body.simbody_index));
  body.angular = Vec3f(blocks.angular_velocity(body.simbody_index));
}

void World::Impl::refresh(Body& body) {
  if (body.group >= 0) return refresh_group(body);
  body.rotation = to_float(body.world_from_com.rotation.matrix());
  if (body.mass > 0) {
    body.inverse_inertia =
        body.rotation * body.inverse_inertia_local * body.rotation.transposed();
  }
  const float scale = float(body.scale);
  const Mat3f scaled = body.rotation * scale;
  const Quad columns[3] = {quad_of(scaled.column(0)), quad_of(scaled.column(1)),
                           quad_of(scaled.column(2))};
  const Vec3& centre = body.world_from_com.translation;
  for (int i = 0; i < body.collider_count; ++i) {
    Collider& collider = data.colliders[body.first_collider + i];
    const auto& corners = body.shape->parts[collider.part].corners;
    Quad low = make_quad(1e30F), high = -low;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      // All three coordinates at once, each by the operations of scaled * corner.
      const Vec3f& c = corners[k];
      const Quad p = columns[0] * make_quad(c.x) + columns[1] * make_quad(c.y) +
                     columns[2] * make_quad(c.z);
      data.corners[collider.first_corner + k] = {p[0], p[1], p[2]};
      low = low < p ? low : p;
      high = high > p ? high : p;
    }
    collider.box = {centre + Vec3(Vec3f{low[0], low[1], low[2]}),
                    centre + Vec3(Vec3f{high[0], high[1], high[2]})};
  }
}

// Pairs of a piece with all others; immovable ones need no pair among themselves.
void World::Impl::find_first_pairs(int index) {
  const Body& body = data.bodies[index];
  each_collider(body, [&](int collider) {
    data.broad.query(collider, [&](int other) { add_contact(collider, other); });
    if (body.mass > 0) add_contact(collider, kGround);
    update_surface_pairs(collider);
  });
}

void World::Impl::list_surfaces() {
  surfaces.clear();
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    if (data.bodies[i].shape->surface) surfaces.push_back(std::int32_t(i));
  }
}

Vec3 World::Impl::linear_velocity(const Body& body) const {
  if (body.tree >= 0) return data.trees[body.tree].links[body.link].linear;
  return body.simbody_index >= 0 ? blocks.linear_velocity(body.simbody_index) : Vec3{};
}

Vec3 World::Impl::angular_velocity(const Body& body) const {
  if (body.tree >= 0) return data.trees[body.tree].links[body.link].angular;
  return body.simbody_index >= 0 ? blocks.angular_velocity(body.simbody_index) : Vec3{};
}

PosedBody World::Impl::posed(const Collider& collider) const {
  const Body& body = data.bodies[collider.body];
  const ConvexShape& shape = data.bodies[collider.piece].shape->parts[collider.part];
  PosedBody result;
  result.part = {&shape,
                 {&data.corners[collider.first_corner], int(shape.corners.size())},
                 &body.rotation,
                 body.collider_count > 1 ? body.shape : nullptr,
                 float(body.scale)};
  result.centre = body.world_from_com.translation;
  result.linear = body.linear;
  result.angular = body.angular;
  return result;
}

World::World(std::vector<PieceType> types, const WorldOptions& options,
             std::vector<AssemblyType> assemblies)
    : impl_(std::make_unique<Impl>(std::move(types), options, std::move(assemblies))) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

int World::add(const std::vector<NewPiece>& pieces) {
  Impl& w = *impl_;
  const int first = size();
  w.data.verification_steps = -1;
  const int types = w.placeable_types, kinds = types + int(w.assemblies.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    check(pieces[i], kinds, int(i));
    check_movable(pieces[i], w.types, types, int(i));
  }
  std::vector<FreeBody> free;  // by body; those of links are not used
  for (const NewPiece& piece : pieces) {
    if (piece.placement.type < types) {
      free.emplace_back();
      w.add_body(piece, &free.back());
    } else {
      w.add_assembly(piece);
      free.resize(std::size_t(size() - first));
    }
  }

  w.add_to_blocks(first, free);
  w.introduce(first);
  return first;
}

// free: by body, from `first` on.
void World::Impl::add_to_blocks(int first, const std::vector<FreeBody>& free) {
  // Neighbours in height land and fall asleep together, so they share a block.
  std::vector<std::int32_t> order;
  for (int i = first; i < int(data.bodies.size()); ++i) {
    if (data.bodies[i].mass > 0 && data.bodies[i].tree < 0) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return data.bodies[a].world_from_com.translation.z <
           data.bodies[b].world_from_com.translation.z;
  });
  std::vector<FreeBody> sorted;
  for (int body : order) sorted.push_back(free[std::size_t(body - first)]);
  int mobile = blocks.add(sorted);
  for (int body : order) data.bodies[body].simbody_index = mobile++;
}

void World::Impl::introduce(int first) {
  const int count = int(data.bodies.size());
  for (int i = first; i < count; ++i) {
    Body& body = data.bodies[i];
    refresh(body);
    for (int c = 0; c < body.collider_count && !body.lost; ++c) {
      const int collider = body.first_collider + c;
      data.broad.update(collider, data.colliders[collider].box, {});
    }
  }
  const std::size_t before = surfaces.size();
  list_surfaces();
  // What was there before may lie near a surface that is new.
  for (int i = surfaces.size() > before ? 0 : first; i < count; ++i) {
    if (!data.bodies[i].lost) find_first_pairs(i);
  }
}

int World::size() const { return int(impl_->data.bodies.size()); }
int World::lost_count() const { return impl_->data.lost; }
std::int64_t World::steps() const { return impl_->data.steps; }
double World::time() const { return double(impl_->data.steps) * impl_->options.step; }
const StepTimes& World::times() const { return impl_->times; }
bool World::is_awake(int index) const { return impl_->acting(index).awake; }
bool World::is_touching(int index) const { return impl_->acting(index).touching; }
double World::mass(int index) const { return impl_->data.bodies[index].mass; }

bool World::verifying_rest() const { return impl_->data.verification_steps >= 0; }

int World::awake_count() const {
  int count = 0;
  for (const Body& body : impl_->data.bodies) count += body.awake;
  return count;
}

PieceState World::piece(int index) const {
  const Body& piece = impl_->data.bodies[index];
  const Body& body = impl_->acting(index);
  PieceState state;
  state.type = piece.type;
  state.layer = piece.layer;
  state.scale = piece.scale;
  state.world_from_body = body.world_from_type();
  state.linear_velocity = impl_->linear_velocity(body);
  if (piece.lead >= 0) {
    const Vec3 origin = body.world_from_com.rotation.rotate(piece.origin_in_group);
    const Vec3 centre = origin + body.world_from_com.rotation.rotate(
                                     piece.shape->volume.centre_of_mass * piece.scale);
    state.world_from_body.translation = body.world_from_com.translation + origin;
    state.linear_velocity += cross(impl_->angular_velocity(body), centre);
  }
  state.angular_velocity = impl_->angular_velocity(body);
  state.status = body.lost        ? PieceStatus::lost
                 : body.mass == 0 ? PieceStatus::fixed
                 : body.awake     ? PieceStatus::moving
                                  : PieceStatus::resting;
  return state;
}

Vec3 World::centre_of_mass(int index) const {
  return impl_->data.bodies[std::size_t(index)].com_in_type;
}

void World::set_velocity(int index, const Vec3& linear, const Vec3& angular) {
  Body& body = impl_->acting(index);
  if (!body.movable()) return;
  impl_->wake(int(&body - impl_->data.bodies.data()));
  if (body.tree >= 0) return impl_->set_tree_motion(index, linear, angular);
  impl_->blocks.set_velocity(body.simbody_index, linear, angular);
  impl_->mirror(body);
}

void World::set_pose(int index, const Pose& world_from_body) {
  Body& body = impl_->data.bodies[index];
  if (!body.movable()) return;
  impl_->wake(index);
  for (const Contact& contact : impl_->data.contacts) {
    if (contact.body_a == index && contact.body_b != kGround) impl_->wake(contact.body_b);
    if (contact.body_b == index) impl_->wake(contact.body_a);
  }
  body.travel += 2 * double(body.radius) +
                 distance(body.world_from_type().translation, world_from_body.translation) +
                 2 * norm(body.com_in_type);
  const Pose world_from_com{normalized(world_from_body.rotation),
                            world_from_body * body.com_in_type};
  if (body.tree >= 0) return impl_->set_tree_pose(index, world_from_com);
  impl_->blocks.set_pose(body.simbody_index, world_from_com);
  impl_->mirror(body);
  impl_->refresh(body);
}

void World::wake_all() {
  for (int i = 0; i < size(); ++i) impl_->wake(i);
}

void World::begin_rest_verification() {
  wake_all();
  for (Body& body : impl_->data.bodies) {
    body.later_pose = body.world_from_com;
    body.later_steps = 0;
  }
  impl_->data.verification_steps = impl_->data.all_awake_since = 0;
}

void World::set_sleeping(bool allowed) {
  impl_->options.sleeping = allowed;
  if (!allowed) wake_all();
}

bool World::at_rest(double speed, double angular_speed) const {
  for (const Body& body : impl_->data.bodies) {
    if (!body.awake) continue;
    if (!body.touching) return false;
    const Vec3 v(body.linear), w(body.angular);
    if (dot(v, v) >= speed * speed || dot(w, w) >= angular_speed * angular_speed) return false;
    // What hangs stands still for a moment where it turns back.
    if (body.tree >= 0 && body.still_steps < int(kHangingTime / impl_->options.step)) return false;
  }
  return true;
}

bool World::rest_verified(double speed, double angular_speed) const {
  if (!verifying_rest() || impl_->data.all_awake_since < 0) return false;
  if (!at_rest(speed, angular_speed)) return false;
  for (int i = 0; i < size(); ++i)
    if (!within_rest_tolerance(i)) return false;
  return true;
}

bool World::within_rest_tolerance(int index) const {
  const Body& body = impl_->acting(index);
  return !body.awake || impl_->within_rest_tolerance(body);
}

void World::put_all_to_sleep() {
  Impl& w = *impl_;
  w.slept.assign(w.data.bodies.size(), 0);
  for (int i = 0; i < size(); ++i) w.slept[i] = w.data.bodies[i].awake;
  w.put_to_sleep();
  w.data.verification_steps = -1;
}

DeepestOverlap World::deepest_overlap() const {
  DeepestOverlap deepest;
  for (std::size_t i = 0; i < impl_->data.pairs.size(); ++i) {
    if (!impl_->data.pairs[i].live) continue;
    const Contact& contact = impl_->data.contacts[i];
    for (int k = 0; k < contact.count; ++k) {
      const double depth = -double(contact.points[k].separation);
      if (depth > deepest.depth) deepest = {depth, contact.body_a, contact.body_b};
    }
  }
  return deepest;
}

bool World::all_have_touched() const {
  for (const Body& body : impl_->data.bodies) {
    if (body.movable() && !body.has_touched) return false;
  }
  return true;
}

double World::highest_point(bool touched_only) const {
  double top = 0;
  for (const Body& body : impl_->data.bodies) {
    if (body.lost || (touched_only && body.mass > 0 && !body.has_touched)) continue;
    impl_->each_collider(body, [&](int i) { top = std::max(top, impl_->data.colliders[i].box.max.z); });
  }
  return top;
}

double World::kinetic_energy() const {
  double sum = 0;
  for (const Body& body : impl_->data.bodies) {
    if (!body.movable()) continue;
    const Vec3 v = impl_->linear_velocity(body);
    const Vec3 w = body.world_from_com.rotation.conjugate().rotate(
        impl_->angular_velocity(body));
    sum += 0.5 * (body.mass * dot(v, v) + dot(w, body.inertia * w));
  }
  return sum;
}

double World::potential_energy() const {
  double sum = 0;
  for (const Body& body : impl_->data.bodies) {
    if (body.movable()) sum += body.mass * impl_->options.gravity * body.world_from_com.translation.z;
  }
  for (std::size_t i = 0; i < impl_->data.trees.size(); ++i) {
    sum += calc_spring_energy(impl_->data.trees[i], impl_->simbody_trees.state(int(i)).q);
  }
  return sum;
}

Vec3 World::linear_momentum() const {
  Vec3 sum;
  for (const Body& body : impl_->data.bodies) {
    if (body.movable()) sum += impl_->linear_velocity(body) * body.mass;
  }
  return sum;
}

Vec3 World::angular_momentum() const {
  Vec3 sum;
  for (const Body& body : impl_->data.bodies) {
    if (!body.movable()) continue;
    const Quat& q = body.world_from_com.rotation;
    const Vec3 v = impl_->linear_velocity(body);
    const Vec3 w = q.conjugate().rotate(impl_->angular_velocity(body));
    sum += cross(body.world_from_com.translation, v * body.mass) + q.rotate(body.inertia * w);
  }
  return sum;
}

}  // namespace rubble
