// Pieces come, go and are asked about one by one, and rest.
#include "kernel/world/world.h"

#include <algorithm>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/multibody/joints/joint.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

void check_movable(const NewPiece& piece, const std::vector<PieceType>& types, int index) {
  const PieceKind kind = piece.placement.kind;
  if (piece.placement.fixed || kind.is_assembly || !types[std::size_t(kind.index)].surface) return;
  Diagnostic d;
  d.key = "pieces[" + std::to_string(index) + "].fixed";
  d.message = "a surface cannot move";
  d.expected = "true";
  d.found = "false";
  throw InputError(d);
}

void check(const NewPiece& piece, const WorldTypes& types, int index) {
  Diagnostic d;
  d.key = "pieces[" + std::to_string(index) + "]";
  const PieceKind kind = piece.placement.kind;
  const int count = kind.is_assembly ? int(types.assemblies.size()) : types.placeable;
  if (kind.index < 0 || kind.index >= count) {
    d.key += kind.is_assembly ? ".assembly" : ".type";
    d.message = "no such " + std::string(kind.is_assembly ? "assembly" : "type");
    d.expected = "0 to " + std::to_string(count - 1);
    d.found = std::to_string(kind.index);
    throw InputError(d);
  }
  if (!(piece.placement.scale >= 0.01 && piece.placement.scale <= 100)) {
    d.key += ".scale";
    d.message = "out of range";
    d.expected = "0.01 to 100";
    d.found = plain_text(piece.placement.scale);
    throw InputError(d);
  }
}


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
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    check(pieces[i], w.types, int(i));
    check_movable(pieces[i], w.types.pieces, int(i));
  }
  std::vector<FreeBody> free;  // by body; those of links are not used
  for (const NewPiece& piece : pieces) {
    if (!piece.placement.kind.is_assembly) {
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

int World::awake_count() const {
  int count = 0;
  for (const Body& body : impl_->data.bodies) count += body.awake;
  return count;
}

std::vector<PieceState> World::pieces() const {
  std::vector<PieceState> all;
  for (int i = 0; i < size(); ++i) all.push_back(piece(i));
  return all;
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

void World::set_sleeping(bool allowed) {
  impl_->settings.options.sleeping = allowed;
  if (!allowed) wake_all();
}

void World::set_step(double step, int substeps) {
  Impl& w = *impl_;
  if (!(step >= 1e-3 && step <= 1.0 / 30 + 1e-12)) {
    throw InputError({"", 0, "step", "out of range", "1/1000 to 1/30 s", plain_text(step), ""});
  }
  if (substeps < 1 || substeps > 64) {
    throw InputError({"", 0, "substeps", "out of range", "1 to 64", std::to_string(substeps), ""});
  }
  const float longer = float(step / w.settings.options.step);
  for (Body& body : w.data.bodies) {
    body.load *= longer, body.grip *= longer;
    body.lost_support *= longer;
  }
  for (Contact& contact : w.data.contacts) contact.rest_pressed *= longer;
  for (Tie& tie : w.data.ties) tie.contact.rest_pressed *= longer;
  w.settings.options.step = step;
  w.settings.solver.step = w.settings.narrow.step = float(step);
  w.settings.solver.substeps = substeps;
}

int World::add_surface(std::shared_ptr<const TriangleMesh> mesh, double friction) {
  Impl& w = *impl_;
  PieceType type;
  type.name = "surface";
  type.surface = std::move(mesh);
  type.friction = friction;
  w.types.shapes.push_back(compile_shape(type, "surface"));
  w.types.pieces.push_back(type);
  NewPiece piece;
  piece.placement.kind = int(w.types.pieces.size()) - 1;
  piece.placement.fixed = true;
  const int number = size();
  FreeBody none;
  w.bodies.add(piece, &none);
  w.pairs.introduce(number);
  return number;
}

std::vector<JointState> World::joints() const {
  const Impl& w = *impl_;
  std::vector<JointState> joints;
  for (const Tree& tree : w.data.trees) {
    for (const TreeLink& link : tree.links) {
      if (link.parent < 0) continue;
      JointState joint;
      joint.parent = tree.links[std::size_t(link.parent)].body;
      joint.child = link.body;
      joint.kind = kind_of(link.mobility);
      joint.parent_from_joint = Pose{{}, w.data.bodies[joint.parent].com_in_type} * link.parent_from_joint;
      joint.child_from_joint = Pose{{}, w.data.bodies[joint.child].com_in_type} * link.link_from_joint;
      joint.rest = link.rest;
      joint.rest_rotation = link.rest_rotation;
      joints.push_back(joint);
    }
    for (const TreeLoop& loop : tree.loops) {
      JointState joint;
      joint.parent = tree.links[std::size_t(loop.link_a)].body;
      joint.child = tree.links[std::size_t(loop.link_b)].body;
      joint.kind = kind_of(loop.mobility);
      joint.parent_from_joint = Pose{{}, w.data.bodies[joint.parent].com_in_type} * loop.a_from_joint;
      joint.child_from_joint = Pose{{}, w.data.bodies[joint.child].com_in_type} * loop.b_from_joint;
      joints.push_back(joint);
    }
  }
  // A piece hangs on one other at most; then come the joints that close loops, as they were made.
  std::stable_sort(joints.begin(), joints.end(),
                   [](const JointState& a, const JointState& b) { return a.child < b.child; });
  return joints;
}

}  // namespace rubble
