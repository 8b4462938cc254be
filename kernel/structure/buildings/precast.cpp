// Columns with corbels, beams that rest on them, hollow floor units that rest on the beams: as in car parks.
// Nothing is continuous over a support.
#include <algorithm>
#include <cmath>

#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

constexpr double kCorbelReach = 0.25;  // from its column; unit: m
constexpr double kCorbelDepth = 0.35;  // height of a corbel; unit: m
constexpr double kBeamApart = 0.02;   // of the end of a beam from its column; unit: m
constexpr double kUnitWidth = 1.2;    // of a floor unit, about; EN 1168; unit: m
constexpr double kUnitApart = 0.005;  // from the beams beside it; unit: m
constexpr double kHollow = 0.6;       // share of a unit that is concrete; unit: 1

class PrecastMaker {
 public:
  explicit PrecastMaker(const BuildingSpec& b)
      : b_(b), concrete_(find_structural_material("concrete", "building.material")), unit_(concrete_) {
    unit_.density *= kHollow;
  }

  std::vector<Member> make() {
    for (int k = 0; k < b_.storeys; ++k) {
      visit_grid(b_, [&](int i, int j) { add_column(k, i, j); },
                 [&](int i, int j, bool along_x) { add_beam(k, i, j, along_x); },
                 [&](int i, int j) { add_units(k, i, j); });
    }
    add_edge();
    RandomStream random(b_.seed, "building parts");
    return resolve_parts(std::move(parts_), b_, random);
  }

 private:
  double top_of(int k) const { return (k + 1) * b_.storey_height; }

  BuildingPart& add(const std::string& name, MemberKind kind, int k, const Aabb& box, double ratio) {
    BuildingPart part;
    part.member.name = name;
    part.member.kind = kind;
    part.member.material = concrete_;
    part.member.bars = make_bars(ratio, kStirrups, 0.05);
    part.member.place.storey = k;
    set_box(part.member, box);
    parts_.push_back(part);
    return parts_.back();
  }

  // Its head, with the corbels, is one piece.
  void add_column(int k, int i, int j) {
    const double x = x_of(b_, i), y = y_of(b_, j), half = b_.column / 2, top = top_of(k);
    const double high = top - b_.beam_depth, low = high - kCorbelDepth;
    MemberPlace& place = add(place_name("column", k, i, j), MemberKind::column, k,
                             {{x - half, y - half, top - b_.storey_height}, {x + half, y + half, low}}, b_.column_bars)
                             .member.place;
    place.i = i, place.j = j, place.bearing = true;
    BuildingPart& head = add(place_name("column head", k, i, j), MemberKind::column, k,
                             {{x - half, y - half, low}, {x + half, y + half, top}}, b_.column_bars);
    head.whole = head.member.place.bearing = true;
    const std::string name = place_name("corbel", k, i, j);
    const auto corbel = [&](const Vec3& from, const Vec3& to) {
      add(name, MemberKind::beam, k, {min(from, to), max(from, to)}, b_.column_bars).whole = true;
    };
    if (i > 0) corbel({x - half, y - half, low}, {x - half - kCorbelReach, y + half, high});
    if (i < b_.bays_x) corbel({x + half, y - half, low}, {x + half + kCorbelReach, y + half, high});
    if (j > 0) corbel({x - half, y - half, low}, {x + half, y - half - kCorbelReach, high});
    if (j < b_.bays_y) corbel({x - half, y + half, low}, {x + half, y + half + kCorbelReach, high});
  }

  // Beams along X carry the units, which lie on them; those along Y are as high as the floor.
  void add_beam(int k, int i, int j, bool along_x) {
    const double half = b_.column / 2, top = top_of(k), low = top - b_.beam_depth;
    const double from = (along_x ? x_of(b_, i) : y_of(b_, j)) + half + kBeamApart;
    const double to = (along_x ? x_of(b_, i + 1) : y_of(b_, j + 1)) - half - kBeamApart;
    const double x = x_of(b_, i), y = y_of(b_, j);
    const Aabb box = along_x ? Aabb{{from, y - half, low}, {to, y + half, top - b_.slab}}
                             : Aabb{{x - half, from, low}, {x + half, to, top}};
    Member& beam = add(place_name(along_x ? "beam along X" : "beam along Y", k, i, j), MemberKind::beam, k, box,
                       b_.beam_bars)
                       .member;
    beam.joint = MemberJoint::seated;
    beam.span_axis = along_x ? 0 : 1;
  }

  // From the middle of a beam to that of the next one; at the edges of the building they cover the beam.
  void add_units(int k, int i, int j) {
    const double half = b_.column / 2, top = top_of(k);
    const double x0 = x_of(b_, i) + half + kUnitApart, x1 = x_of(b_, i + 1) - half - kUnitApart;
    const double y0 = y_of(b_, j) - (j == 0 ? half : 0), y1 = y_of(b_, j + 1) + (j + 1 == b_.bays_y ? half : 0);
    const int count = std::max(1, int(std::lround((x1 - x0) / kUnitWidth)));
    for (int m = 0; m < count; ++m) {
      const Aabb box{{x0 + (x1 - x0) * m / count, y0, top - b_.slab}, {x0 + (x1 - x0) * (m + 1) / count, y1, top}};
      Member& unit = add(place_name("floor unit " + std::to_string(m), k, i, j), MemberKind::slab, k, box,
                         b_.slab_bars)
                         .member;
      unit.material = unit_;
      unit.joint = MemberJoint::seated;
      unit.span_axis = 1;
      unit.bars.cover = 0.03, unit.bars.stirrups = kDowels;
    }
  }

  void add_edge() {
    if (!(b_.parapet > 0)) return;
    BuildingSpec with = b_;
    with.infill = Infill::none;
    for (int k = 0; k < b_.storeys; ++k) {
      with.storeys = k + 1;
      add_parapet(with, b_.column, parts_);
    }
  }

  const BuildingSpec& b_;
  StructuralMaterial concrete_, unit_;
  std::vector<BuildingPart> parts_;
};

}  // namespace

std::vector<Member> make_precast(const BuildingSpec& building) { return PrecastMaker(building).make(); }

}  // namespace rubble
