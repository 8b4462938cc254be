// A frame of reinforced concrete with flat floors and walls between its outer columns.
#include <algorithm>
#include <cmath>

#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {


class FrameMaker {
 public:
  explicit FrameMaker(const BuildingSpec& b)
      : b_(b), random_(b.seed, "building variants"),
        concrete_(find_structural_material("concrete", "building.material")) {}

  std::vector<Member> make() {
    for (int k = 0; k < b_.storeys; ++k) {
      visit_grid(b_, [&](int i, int j) { add_column(k, i, j); },
                 [&](int i, int j, bool along_x) { add_beam(k, i, j, along_x); },
                 [&](int i, int j) { add_slab(k, i, j); });
      if (b_.infill != Infill::none) add_walls(k);
    }
    if (!b_.plain()) add_parts();
    return std::move(members_);
  }

 private:
  double x_of(double i) const { return rubble::x_of(b_, i); }
  double y_of(double j) const { return rubble::y_of(b_, j); }
  double top_of(int storey) const { return (storey + 1) * b_.storey_height; }

  int count(double length) const {
    return std::clamp(int(std::lround(length / b_.piece)), 1, 40);
  }

  Member& add(const std::string& name, MemberKind kind, const Vec3& centre, const Vec3& size,
              const StructuralMaterial& material) {
    Member m;
    m.name = name;
    m.kind = kind;
    m.centre = centre;
    m.size = size;
    m.material = material;
    m.cut.roughness = b_.roughness;
    m.variant = int(random_.below(kVariants));
    members_.push_back(m);
    return members_.back();
  }

  // What a frame has beside: slabs make room for what goes through them.
  void add_parts() {
    std::vector<BuildingPart> parts;
    std::vector<Aabb> openings;
    add_partitions(b_, parts);
    add_parapet(b_, b_.column, parts);
    for (const BayPlace& bay : b_.stairs) add_stairs(b_, bay, parts, openings);
    for (const BayPlace& bay : b_.cores) add_core(b_, bay, parts, openings);
    const auto is_opened = [&](const Member& member) {
      return member.kind == MemberKind::slab && std::any_of(openings.begin(), openings.end(), [&](const Aabb& o) {
               return overlap(box_of(member), o);
             });
    };
    for (const Member& member : members_) {
      if (is_opened(member)) parts.push_back({member, kSlabRank, openings, false, 0});
    }
    members_.erase(std::remove_if(members_.begin(), members_.end(), is_opened), members_.end());
    RandomStream random(b_.seed, "building parts");
    for (const Member& member : resolve_parts(parts, b_, random)) members_.push_back(member);
  }

  void add_column(int k, int i, int j) {
    const double clear = b_.storey_height - b_.beam_depth, bottom = k * b_.storey_height;
    Member& column = add(place_name("column", k, i, j), MemberKind::column,
                         {x_of(i), y_of(j), bottom + clear / 2}, {b_.column, b_.column, clear}, concrete_);
    column.cut.counts[2] = count(clear);
    column.cut.slope = kColumnSlope;
    column.bars = make_bars(b_.column_bars, kStirrups, 0.05);
    column.place = {k, i, j, "", false, true};
    Member& head = add(place_name("column head", k, i, j), MemberKind::column,
                       {x_of(i), y_of(j), top_of(k) - b_.beam_depth / 2},
                       {b_.column, b_.column, b_.beam_depth}, concrete_);
    head.bars = make_bars(b_.column_bars, kStirrups, 0.05);
    head.variant = 0;
    head.place.storey = k;
    head.place.bearing = true;
  }

  void add_beam(int k, int i, int j, bool along_x) {
    const double clear = (along_x ? b_.span_x : b_.span_y) - b_.column;
    const double x = along_x ? x_of(i + 0.5) : x_of(i), y = along_x ? y_of(j) : y_of(j + 0.5);
    const Vec3 size = along_x ? Vec3{clear, b_.column, b_.beam_depth} : Vec3{b_.column, clear, b_.beam_depth};
    Member& beam = add(place_name(along_x ? "beam along X" : "beam along Y", k, i, j), MemberKind::beam,
                       {x, y, top_of(k) - b_.beam_depth / 2}, size, concrete_);
    beam.cut.counts[along_x ? 0 : 1] = count(clear);
    beam.bars = make_bars(b_.beam_bars, kStirrups, 0.05);
  }

  void add_slab(int k, int i, int j) {
    const Vec3 size{b_.span_x - b_.column, b_.span_y - b_.column, b_.slab};
    Member& slab = add(place_name("slab", k, i, j), MemberKind::slab,
                       {x_of(i + 0.5), y_of(j + 0.5), top_of(k) - b_.slab / 2}, size, concrete_);
    slab.cut.counts[0] = count(size.x);
    slab.cut.counts[1] = count(size.y);
    slab.bars = make_bars(b_.slab_bars, kDowels, 0.03);
    slab.place.storey = k;
  }

  void add_walls(int k) {
    for (int i = 0; i < b_.bays_x; ++i) {
      for (const int j : {0, b_.bays_y}) add_wall(k, i, j, true);
    }
    for (int j = 0; j < b_.bays_y; ++j) {
      for (const int i : {0, b_.bays_x}) add_wall(k, i, j, false);
    }
  }

  // Solid, or a window in its middle: what is left of it, what is right, the sill and the lintel.
  void add_wall(int k, int i, int j, bool along_x) {
    const double length = (along_x ? b_.span_x : b_.span_y) - b_.column;
    const double height = b_.storey_height - b_.beam_depth, bottom = k * b_.storey_height;
    const double open = length * b_.openings, side = (length - open) / 2;
    const double sill = height * kWindowSill, head = height * kWindowHead;
    const double along = along_x ? x_of(i + 0.5) : y_of(j + 0.5);
    const double across = along_x ? y_of(j) : x_of(i);
    const auto panel = [&](double from, double to, double low, double high) {
      const double l = to - from, h = high - low, middle = along + (from + to) / 2;
      const Vec3 centre{along_x ? middle : across, along_x ? across : middle, bottom + (low + high) / 2};
      const Vec3 size = along_x ? Vec3{l, b_.infill_thickness, h} : Vec3{b_.infill_thickness, l, h};
      Member& wall = add(place_name(along_x ? "wall along X" : "wall along Y", k, i, j), MemberKind::wall,
                         centre, size, material_of(b_.infill));
      wall.cut.counts[along_x ? 0 : 1] = count(l);
      wall.cut.counts[2] = count(h);
      wall.stiffness = kInfillStiffness;
      wall.place.storey = k, wall.place.infill = true;
    };
    const double half = length / 2;
    if (!(open > 0.2)) return panel(-half, half, 0, height);
    panel(-half, -half + side, 0, height);
    panel(half - side, half, 0, height);
    panel(-half + side, half - side, 0, sill);
    panel(-half + side, half - side, head, height);
  }

  const BuildingSpec& b_;
  RandomStream random_;
  StructuralMaterial concrete_;
  std::vector<Member> members_;
};

}  // namespace

std::vector<Member> make_frame(const BuildingSpec& building) { return FrameMaker(building).make(); }

}  // namespace rubble
