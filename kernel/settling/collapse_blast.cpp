// A blast is over before anything has moved: every piece that it reaches has its impulse as speed, and comes off if
// that is more energy than its bonds take. This is the impulsive limit of pressure-impulse diagrams (Baker, Cox,
// Westine, Kulesz and Strehlow 1983, "Explosion Hazards and Evaluation").
#include <algorithm>
#include <cmath>

#include "kernel/geometry/hull.h"
#include "kernel/settling/collapse_impl.h"

namespace rubble {
namespace {

constexpr double kNearest = 1;      // a blast is as strong nearer than this; unit: m
constexpr double kInFront = 0.005;  // of a face: where the ray from the charge ends; unit: m

struct BlastFace {
  Vec3 centre, normal;
  double area = 0;    // unit: m2
  double offset = 0;  // of its plane along the normal; unit: m
};

// In the frame of its type, whose axes are those of the structure.
using BlastShape = std::vector<BlastFace>;

BlastShape make_blast_shape(const PieceType& type) {
  BlastShape shape;
  const Hull hull = calc_hull(type.parts[0].points);
  for (const auto& corners : hull.faces) {
    BlastFace face;
    Vec3 sum;
    const Vec3& a = hull.points[corners[0]];
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vec3 &b = hull.points[corners[i]], &c = hull.points[corners[i + 1]];
      const Vec3 area = cross(b - a, c - a) * 0.5;
      sum += area;
      face.centre += (a + b + c) * (norm(area) / 3);
      face.area += norm(area);
    }
    if (!(face.area > 0)) continue;
    face.centre = face.centre * (1 / face.area);
    face.normal = normalized(sum);
    face.offset = dot(face.normal, a);
    shape.push_back(face);
  }
  return shape;
}

// Whether the way from a to b leads through it.
bool lies_between(const BlastShape& shape, const Vec3& position, const Vec3& a, const Vec3& b) {
  double enter = 0, leave = 1;
  for (const BlastFace& face : shape) {
    const double from = dot(face.normal, a - position) - face.offset, to = dot(face.normal, b - position) - face.offset;
    if (from > 0 && to > 0) return false;
    if (from > 0) enter = std::max(enter, from / (from - to));
    if (to > 0) leave = std::min(leave, from / (from - to));
    if (enter >= leave) return false;
  }
  return true;
}

// What a charge does to each piece. Faces that it does not see are in the shadow of others.
class Charge {
 public:
  Charge(const Structure& structure, const Vec3& at, double impulse_at_1m)
      : structure_(structure), at_(at), impulse_(impulse_at_1m) {
    for (const PieceType& type : structure.types) shapes_.push_back(make_blast_shape(type));
  }

  Vec3 impulse_on(std::size_t piece) const {
    const StructurePiece& hit = structure_.pieces[piece];
    Vec3 sum;
    for (const BlastFace& face : shapes_[hit.type]) {
      const Vec3 centre = hit.position + face.centre, way = centre - at_;
      const double r = norm(way), facing = r > 0 ? -dot(face.normal, way) / r : 0;
      if (!(facing > 0) || is_hidden(piece, centre - way * (kInFront / r))) continue;
      const double near = std::max(kNearest, r);
      sum -= face.normal * (impulse_ * facing * face.area / (near * near));
    }
    return sum;
  }

 private:
  bool is_hidden(std::size_t piece, const Vec3& place) const {
    for (std::size_t i = 0; i < structure_.pieces.size(); ++i) {
      const StructurePiece& other = structure_.pieces[i];
      if (i != piece && lies_between(shapes_[other.type], other.position, at_, place)) return true;
    }
    return false;
  }

  const Structure& structure_;
  Vec3 at_;
  double impulse_;
  std::vector<BlastShape> shapes_;  // by type
};

}  // namespace

// Breaks the pieces off, as one, if the blast brings the energy for that; what it brings for more breaks the bonds
// between them.
bool Collapse::Impl::blow_off(const std::vector<std::int32_t>& pieces, const std::vector<Vec3>& impulses,
                              std::vector<BondFailure>& failures) {
  std::vector<std::uint8_t> inside(structure.pieces.size());
  Vec3 impulse;
  double mass = 0;
  for (const std::int32_t piece : pieces) {
    inside[piece] = 1;
    impulse += impulses[piece], mass += structure.pieces[piece].mass;
  }
  double around = 0, within = 0;
  std::vector<BondFailure> failing, also;
  for (std::size_t i = 0; i < structure.bonds.size(); ++i) {
    const Bond& bond = structure.bonds[i];
    const bool a = inside[bond.piece_a], b = bond.piece_b != kFoundation && inside[bond.piece_b];
    if (status[i].broken || (!a && !b)) continue;
    (a && b ? within : around) += calc_breaking_energy(bond.section);
    (a && b ? also : failing).push_back({std::int32_t(i), FailureMode::shear, false, 0, false});
  }
  const double energy = 0.5 * dot(impulse, impulse) / mass;
  if (!(energy > around)) return false;
  double taken = around;
  if (energy > around + within) taken += within, failing.insert(failing.end(), also.begin(), also.end());
  for (BondFailure& failure : failing) {
    failure.utilization = taken > 0 ? energy / taken : 1;
    status[failure.bond].broken = true;
    ++report.broken;
    failures.push_back(failure);
  }
  report.energy_taken += taken;
  const double keep = std::sqrt(1 - taken / energy);
  for (const std::int32_t piece : pieces) blasted[piece] = impulses[piece] * keep;
  return true;
}

void Collapse::blast(const Vec3& at, double impulse_at_1m) {
  Impl& c = *impl_;
  const Structure& s = c.structure;
  const Charge charge(s, at, impulse_at_1m);
  std::vector<Vec3> impulses;
  std::vector<std::vector<std::int32_t>> of_member(s.members.size());
  for (std::size_t i = 0; i < s.pieces.size(); ++i) {
    impulses.push_back(charge.impulse_on(i));
    if (dot(impulses[i], impulses[i]) > 0) of_member[s.pieces[i].member].push_back(std::int32_t(i));
  }
  // A panel goes as a whole where it can, else what is hit the hardest of it.
  std::vector<BondFailure> failures;
  for (const auto& pieces : of_member) {
    if (pieces.empty() || c.blow_off(pieces, impulses, failures)) continue;
    for (const std::int32_t piece : pieces) c.blow_off({piece}, impulses, failures);
  }
  if (failures.empty()) return;
  c.tie(failures);
  std::vector<std::int32_t> leads;
  for (const auto& part : c.parts) leads.push_back(part.first);
  for (const std::int32_t lead : leads) c.replace(lead, c.groups_left_of(lead));
}

}  // namespace rubble
