#include "kernel/settling/collapse.h"

#include <algorithm>
#include <utility>

#include "kernel/base/inertia.h"
#include "kernel/settling/collapse_impl.h"
#include "kernel/world/world_structures.h"

namespace rubble {

Collapse::Collapse(World& world, const Structure& structure, int first_type,
                   const CollapseOptions& options, std::vector<SectionForces> settled)
    : impl_(std::make_unique<Impl>(world, structure, first_type, options, std::move(settled))) {
  world.structures().set_on_solved([this] { return impl_->on_solved(); });
}

Collapse::~Collapse() { impl_->world.structures().set_on_solved({}); }

void Collapse::begin_step(const Vec3& ground_acceleration) {
  impl_->ground_acceleration = ground_acceleration;
  impl_->ride();
  impl_->accelerate();
}

void Collapse::end_step() {
  impl_->drain();
  impl_->strike();
  impl_->sinks = false;
  impl_->throw_blasted();
  impl_->settle_forces();
}

bool Collapse::is_sinking() const { return impl_->rides; }
bool Collapse::is_breaking() const { return impl_->breaking || impl_->struck >= 0; }
int Collapse::arrests() const { return impl_->arrests; }
int Collapse::first_piece() const { return impl_->first; }
int Collapse::piece_count() const { return int(impl_->structure.pieces.size()); }

CollapseReport Collapse::report() const {
  CollapseReport report = impl_->report;
  report.torn = report.ties - impl_->world.structures().tie_count();
  report.tie_energy = impl_->world.structures().tie_energy();
  return report;
}

// The loads on the pieces of a body: weight, inertia, contacts and causes.

namespace {

// Changes of a load below this share of a mean piece's weight do not count as changes. unit: 1
constexpr double kSameLoad = 0.3;
// Where the ground shakes so weakly that this would hide all of it: the same as a share of what the strongest shake does to the
// heaviest piece. unit: 1
constexpr double kSameShake = 0.25;

}  // namespace

// Loads by piece of the structure; only those of the body are set.
std::vector<PieceLoad> Collapse::Impl::calc_loads(std::int32_t lead, const Part& part,
                                                  const Touches& touches, bool with_impacts) const {
  const BondGroup& group = part.stress->group();
  std::vector<PieceLoad> loads(structure.pieces.size());
  const PieceState state = world.piece(first + lead);
  const Quat back = state.world_from_body.rotation.conjugate();
  const Vec3 pull = back.rotate(Vec3{0, 0, -options.gravity} - ground_acceleration);
  Vec3 force = pull * part.mass, torque;
  const auto push = [&](std::int32_t piece, const Vec3& f, const Vec3& point) {
    loads[piece].force += f;
    loads[piece].moment += cross(point - structure.pieces[piece].centre, f);
    force += f;
    torque += cross(point - part.centre, f);
  };
  for (const auto& [piece, touch] : touches) {
    if (with_impacts || !touch.impact) push(piece, touch.force, touch.point);
  }
  if (struck >= 0 && lead_of[struck] == lead) {
    const Pose pose = world.piece(first + struck).world_from_body;
    push(struck, back.rotate(strike_force()),
         structure.pieces[struck].position + back.rotate(strike_at - pose.translation));
  }
  if (group.anchored) {
    for (const std::int32_t i : group.pieces) loads[i].force += pull * structure.pieces[i].mass;
    return loads;
  }
  const Vec3 spin = back.rotate(state.angular_velocity);
  const Vec3 linear = force * (1 / part.mass);
  const Vec3 angular = inverse_of(part.inertia) * (torque - cross(spin, part.inertia * spin));
  for (const std::int32_t i : group.pieces) {
    const StructurePiece& piece = structure.pieces[i];
    const Vec3 r = piece.centre - part.centre;
    const Vec3 a = linear + cross(angular, r) + cross(spin, cross(spin, r));
    loads[i].force += (pull - a) * piece.mass;
    loads[i].moment -= piece.inertia * angular + cross(spin, piece.inertia * spin);
  }
  return loads;
}

bool Collapse::Impl::is_news(const Part& part, const std::vector<PieceLoad>& loads) const {
  const BondGroup& group = part.stress->group();
  if (part.solved.empty() || (sinks && group.anchored)) return true;
  double most = kSameLoad * part.mass * options.gravity / double(group.pieces.size());
  if (options.shake > 0) {
    double heaviest = 0;
    for (const std::int32_t i : group.pieces) heaviest = std::max(heaviest, structure.pieces[i].mass);
    if (options.shake * heaviest <= most) most = kSameShake * options.shake * heaviest;
  }
  for (std::size_t i = 0; i < group.pieces.size(); ++i) {
    if (norm(loads[group.pieces[i]].force - part.solved[i].force) > most) return true;
  }
  return false;
}

}  // namespace rubble
