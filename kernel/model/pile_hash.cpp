#include "kernel/model/pile_hash.h"

#include "kernel/base/hash_pose.h"

namespace rubble {
namespace {

void add_count(StateHash& hash, std::size_t count) { hash.add(std::uint64_t(count)); }

void add(StateHash& hash, const PieceType& type) {
  add_count(hash, type.parts.size());
  for (const ConvexPart& part : type.parts) {
    add_count(hash, part.points.size());
    for (const Vec3& point : part.points) add(hash, point);
  }
  hash.add(std::uint8_t(type.volume.has_value()));
  if (type.volume) {
    hash.add(type.volume->volume);
    add(hash, type.volume->centre_of_mass);
    for (const Vec3& row : type.volume->inertia.rows) add(hash, row);
  }
  hash.add(type.density);
  hash.add(type.friction);
  if (!type.surface) return;
  for (const Vec3f& p : type.surface->positions) add(hash, Vec3(p));
  for (const auto& corners : type.surface->triangles) {
    for (const std::uint32_t corner : corners) hash.add(std::int32_t(corner));
  }
}

// types: of the pile; the number of an assembly follows theirs.
void add(StateHash& hash, const std::vector<Placement>& placements, std::size_t types) {
  add_count(hash, placements.size());
  for (const Placement& placement : placements) {
    hash.add(std::int32_t(placement.kind.index + (placement.kind.is_assembly ? int(types) : 0)));
    hash.add(placement.scale);
    add(hash, placement.world_from_body);
    hash.add(std::uint8_t(placement.fixed));
  }
}

void add(StateHash& hash, const std::vector<PieceType>& types) {
  add_count(hash, types.size());
  for (const PieceType& type : types) add(hash, type);
}

void add(StateHash& hash, const std::vector<AssemblyType>& assemblies) {
  add_count(hash, assemblies.size());
  for (const AssemblyType& assembly : assemblies) {
    add_count(hash, assembly.links.size());
    for (const AssemblyLink& link : assembly.links) {
      hash.add(std::int32_t(link.type));
      add(hash, link.assembly_from_link);
      hash.add(link.scale);
    }
    for (const JointType& j : assembly.joints) {
      for (int number : {j.parent, j.child, int(j.kind), int(j.collide)}) {
        hash.add(std::int32_t(number));
      }
      add(hash, j.assembly_from_joint);
      for (double number : {j.stiffness, j.damping, j.friction, j.yield, j.break_force, j.break_torque,
                            j.lower, j.upper}) {
        hash.add(number);
      }
    }
  }
}

void add(StateHash& hash, const std::string& text) {
  add_count(hash, text.size());
  for (const char c : text) hash.add(std::uint8_t(c));
}

// What a plain frame does not have.
void add_parts(StateHash& hash, const BuildingSpec& b) {
  hash.add(std::uint8_t(b.kind));
  hash.add(std::uint8_t(b.partitions));
  for (const double number : {b.parapet, b.wall, b.joist_depth, b.joist_width, b.joist_spacing}) hash.add(number);
  for (const auto* bays : {&b.stairs, &b.cores}) {
    add_count(hash, bays->size());
    for (const BayPlace& bay : *bays) hash.add(std::int32_t(bay.i)), hash.add(std::int32_t(bay.j));
  }
  add_count(hash, b.plan.heights.size());
  for (const double height : b.plan.heights) hash.add(height);
  add_count(hash, b.plan.parts.size());
  for (const PlanPart& p : b.plan.parts) {
    for (const int number : {int(p.kind), p.lowest, p.highest, int(p.material)}) hash.add(std::int32_t(number));
    for (const double number : {p.x1, p.y1, p.x2, p.y2, p.thickness, p.depth, p.bottom, p.top, p.bars}) hash.add(number);
    add(hash, p.name);
  }
  for (const ColumnPlace& p : b.cause.removed) add(hash, p.part);
  for (const SinkingFooting& f : b.cause.sinking) add(hash, f.part);
  add(hash, b.cause.vehicle.part);
}

void add(StateHash& hash, const BuildingSpec& b) {
  const CollapseCause& c = b.cause;
  for (const int number : {b.storeys, b.bays_x, b.bays_y, c.weak_storey, c.overloaded_floor}) {
    hash.add(std::int32_t(number));
  }
  for (const double number :
       {b.span_x, b.span_y, b.storey_height, b.column, b.beam_depth, b.slab, b.column_bars, b.beam_bars,
        b.slab_bars, b.infill_thickness, b.openings, b.piece, b.roughness, c.weakness, c.overload, c.shake,
        c.shake_hz, c.shake_seconds, c.shake_direction_deg, c.blast, b.continuity, c.accelerogram_step,
        c.vehicle.mass, c.vehicle.speed, c.vehicle.direction_deg, c.vehicle.stiffness, c.vehicle.height}) {
    hash.add(number);
  }
  add(hash, c.blast_at);
  hash.add(std::uint8_t(b.infill));
  hash.add(b.seed);
  add_count(hash, c.removed.size());
  for (const ColumnPlace& p : c.removed) {
    for (const int number : {p.storey, p.i, p.j}) hash.add(std::int32_t(number));
  }
  for (const int number : {c.vehicle.i, c.vehicle.j}) hash.add(std::int32_t(number));
  add_count(hash, c.accelerogram.size());
  for (const double acceleration : c.accelerogram) hash.add(acceleration);
  add_count(hash, c.sinking.size());
  for (const SinkingFooting& f : c.sinking) {
    hash.add(std::int32_t(f.i)), hash.add(std::int32_t(f.j)), hash.add(f.depth);
  }
  if (!b.plain()) add_parts(hash, b);
}

}  // namespace

std::uint64_t hash_types(const std::vector<PieceType>& types,
                         const std::vector<AssemblyType>& assemblies) {
  StateHash hash;
  add(hash, types);
  if (!assemblies.empty()) add(hash, assemblies);
  return hash.digest();
}

std::uint64_t hash_pile(const Pile& pile) {
  StateHash hash;
  add(hash, pile.types);
  add(hash, pile.placed, pile.types.size());
  add_count(hash, pile.layers.size());
  for (const Layer& layer : pile.layers) add(hash, layer.pieces, pile.types.size());
  hash.add(pile.spawn_bottom);
  if (!pile.assemblies.empty()) add(hash, pile.assemblies);
  if (pile.building.given()) add(hash, pile.building), hash.add(std::int32_t(pile.building_first_type));
  return hash.digest();
}

}  // namespace rubble
