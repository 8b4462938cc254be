// Pieces come, go and are asked about one by one, and rest.
#include "kernel/world/world.h"

#include <algorithm>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

void check_movable(const NewPiece& piece, const std::vector<PieceType>& types, int placeable, int index) {
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
    : pool(world_options.threads) {
  types.pieces = std::move(piece_types);
  types.placeable = int(types.pieces.size());
  types.assemblies = std::move(assembly_types);
  settings.options = world_options;
  settings.solver.step = settings.narrow.step = float(settings.options.step);
  settings.solver.gravity = float(settings.options.gravity);
  for (std::size_t i = 0; i < types.pieces.size(); ++i) {
    types.shapes.push_back(compile_shape(types.pieces[i], "types[" + std::to_string(i) + "]"));
  }
  for (std::size_t i = 0; i < types.assemblies.size(); ++i) {
    const std::string key = "assemblies[" + std::to_string(i) + "]";
    validate(types.assemblies[i], int(types.pieces.size()), key);
    for (const AssemblyLink& link : types.assemblies[i].links) {
      if (!types.pieces[link.type].surface) continue;
      throw InputError({"", 0, key, "a link is a surface, which cannot move", "", "", ""});
    }
  }
}

World::World(std::vector<PieceType> types, const WorldOptions& options, std::vector<AssemblyType> assemblies)
    : impl_(std::make_unique<Impl>(std::move(types), options, std::move(assemblies))) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

int World::add(const std::vector<NewPiece>& pieces) {
  Impl& w = *impl_;
  const int first = size();
  w.data.verification_steps = -1;
  const int types = w.types.placeable, kinds = types + int(w.types.assemblies.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    check(pieces[i], kinds, int(i));
    check_movable(pieces[i], w.types.pieces, types, int(i));
  }
  std::vector<FreeBody> free;  // by body; those of links are not used
  for (const NewPiece& piece : pieces) {
    if (piece.placement.type < types) {
      free.emplace_back();
      w.bodies.add(piece, &free.back());
    } else {
      w.trees.add_assembly(piece);
      free.resize(std::size_t(size() - first));
    }
  }

  w.bodies.add_to_blocks(first, free);
  w.pairs.introduce(first);
  return first;
}

int World::size() const { return int(impl_->data.bodies.size()); }
int World::lost_count() const { return impl_->data.lost; }
std::int64_t World::steps() const { return impl_->data.steps; }
double World::time() const { return double(impl_->data.steps) * impl_->settings.options.step; }
bool World::is_awake(int index) const { return impl_->bodies.acting(index).awake; }
bool World::is_touching(int index) const { return impl_->bodies.acting(index).touching; }
double World::mass(int index) const { return impl_->data.bodies[index].mass; }

bool World::verifying_rest() const { return impl_->data.verification_steps >= 0; }

int World::awake_count() const {
  int count = 0;
  for (const Body& body : impl_->data.bodies) count += body.awake;
  return count;
}

PieceState World::piece(int index) const {
  const Body& piece = impl_->data.bodies[index];
  const Body& body = impl_->bodies.acting(index);
  PieceState state;
  state.type = piece.type;
  state.layer = piece.layer;
  state.scale = piece.scale;
  state.world_from_body = body.world_from_type();
  state.linear_velocity = impl_->bodies.linear_velocity(body);
  if (piece.lead >= 0) {
    const Vec3 origin = body.world_from_com.rotation.rotate(piece.origin_in_group);
    const Vec3 centre =
        origin + body.world_from_com.rotation.rotate(piece.shape->volume.centre_of_mass * piece.scale);
    state.world_from_body.translation = body.world_from_com.translation + origin;
    state.linear_velocity += cross(impl_->bodies.angular_velocity(body), centre);
  }
  state.angular_velocity = impl_->bodies.angular_velocity(body);
  state.status = body.lost        ? PieceStatus::lost
                 : body.mass == 0 ? PieceStatus::fixed
                 : body.awake     ? PieceStatus::moving
                                  : PieceStatus::resting;
  return state;
}

Vec3 World::centre_of_mass(int index) const { return impl_->data.bodies[std::size_t(index)].com_in_type; }

void World::set_velocity(int index, const Vec3& linear, const Vec3& angular) {
  Body& body = impl_->bodies.acting(index);
  if (!body.movable()) return;
  impl_->waking.wake(int(&body - impl_->data.bodies.data()));
  if (body.tree >= 0) return impl_->trees.set_motion(index, linear, angular);
  impl_->blocks.set_velocity(body.free_index, linear, angular);
  impl_->bodies.mirror(body);
}

void World::set_pose(int index, const Pose& world_from_body) {
  Body& body = impl_->data.bodies[index];
  if (!body.movable()) return;
  impl_->waking.wake(index);
  for (const Contact& contact : impl_->data.contacts) {
    if (contact.body_a == index && contact.body_b != kGround) impl_->waking.wake(contact.body_b);
    if (contact.body_b == index) impl_->waking.wake(contact.body_a);
  }
  body.travel += 2 * double(body.radius) +
                 distance(body.world_from_type().translation, world_from_body.translation) +
                 2 * norm(body.com_in_type);
  const Pose world_from_com{normalized(world_from_body.rotation), world_from_body * body.com_in_type};
  if (body.tree >= 0) return impl_->trees.set_pose(index, world_from_com);
  impl_->blocks.set_pose(body.free_index, world_from_com);
  impl_->bodies.mirror(body);
  impl_->bodies.refresh(body);
}

void World::wake_all() {
  for (int i = 0; i < size(); ++i) impl_->waking.wake(i);
}

void World::begin_rest_verification(double limit) {
  wake_all();
  for (Body& body : impl_->data.bodies) {
    body.later_pose = body.world_from_com;
    body.later_steps = 0;
  }
  impl_->data.verification_steps = impl_->data.all_awake_since = 0;
  impl_->data.verification_limit = std::int64_t(std::min(limit, kLongestVerification) / impl_->settings.options.step);
  impl_->data.undamped_since = -1;
  impl_->data.undamped_tries = 0;
}

void World::set_sleeping(bool allowed) {
  impl_->settings.options.sleeping = allowed;
  if (!allowed) wake_all();
}

bool World::at_rest(double speed, double angular_speed) const {
  for (const Body& body : impl_->data.bodies) {
    if (!body.awake) continue;
    if (!body.touching) return false;
    const Vec3 v(body.linear), w(body.angular);
    if (dot(v, v) >= speed * speed || dot(w, w) >= angular_speed * angular_speed) return false;
    // What hangs stands still for a moment where it turns back.
    if (body.tree >= 0 && body.still_steps < int(kHangingTime / impl_->settings.options.step)) return false;
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
  const Body& body = impl_->bodies.acting(index);
  return !body.awake || impl_->sleep.within_rest_tolerance(body);
}

void World::put_all_to_sleep() { impl_->sleep.put_all_to_sleep(impl_->step_pairs); }

int World::add_surface(std::shared_ptr<const TriangleMesh> mesh, double friction) {
  Impl& w = *impl_;
  PieceType type;
  type.name = "surface";
  type.surface = std::move(mesh);
  type.friction = friction;
  w.types.shapes.push_back(compile_shape(type, "surface"));
  w.types.pieces.push_back(type);
  NewPiece piece;
  piece.placement.type = int(w.types.pieces.size()) - 1;
  piece.placement.fixed = true;
  const int number = size();
  FreeBody none;
  w.bodies.add(piece, &none);
  w.pairs.introduce(number);
  return number;
}

}  // namespace rubble
