#include "kernel/structure/frame_building.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/base/error.h"

namespace rubble {
namespace {

// Equal members share one of this many cuts: few enough types, and no visible repetition. unit: 1
constexpr int kVariants = 3;
// Shear strength by the stirrups of columns and beams; two legs of 8 mm every 0.2 m in 0.4 m give 0.7 MPa.
// unit: Pa
constexpr double kStirrups = 0.8e6;
// Infill stands in its frame with gaps at the top and sides, and cracks away long before the frame bends:
// it loads the frame and hardly stiffens it.
constexpr double kInfillStiffness = 0.01;  // unit: 1
// Bars of slabs act as dowels where loads are carried by few of the coarse pieces; our choice. unit: Pa
constexpr double kDowels = 0.5e6;
// Pressed concrete fails along planes of 45 degrees and half its angle of friction, 33 degrees (Mohr and
// Coulomb): what is left of a column slides off instead of standing as a stack. unit: 1
constexpr double kColumnSlope = 1.85;
constexpr double kWindowSill = 0.35;  // height of a window's lower edge, as a share of the wall's height; unit: 1
constexpr double kWindowHead = 0.8;   // height of a window's upper edge, as a share of the wall's height; unit: 1

struct Range {
  const char* key;
  double value, low, high;
};

std::string name_of(const char* what, int storey, int i, int j) {
  return std::string(what) + " (" + std::to_string(i) + ", " + std::to_string(j) + ") of storey " +
         std::to_string(storey);
}

class FrameMaker {
 public:
  explicit FrameMaker(const BuildingSpec& b)
      : b_(b), random_(b.seed, "building variants"),
        concrete_(find_structural_material("concrete", "building.material")) {}

  std::vector<Member> make() {
    for (int k = 0; k < b_.storeys; ++k) {
      for (int j = 0; j <= b_.bays_y; ++j) {
        for (int i = 0; i <= b_.bays_x; ++i) add_column(k, i, j);
      }
      for (int j = 0; j <= b_.bays_y; ++j) {
        for (int i = 0; i < b_.bays_x; ++i) add_beam(k, i, j, true);
      }
      for (int j = 0; j < b_.bays_y; ++j) {
        for (int i = 0; i <= b_.bays_x; ++i) add_beam(k, i, j, false);
      }
      for (int j = 0; j < b_.bays_y; ++j) {
        for (int i = 0; i < b_.bays_x; ++i) add_slab(k, i, j);
      }
      if (b_.infill != Infill::none) add_walls(k);
    }
    return std::move(members_);
  }

 private:
  double x_of(double i) const { return (i - b_.bays_x / 2.0) * b_.span_x; }
  double y_of(double j) const { return (j - b_.bays_y / 2.0) * b_.span_y; }
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

  Reinforcement bars(double ratio, double stirrups, double cover) const {
    Reinforcement r;
    r.ratio = ratio;
    r.side_ratio = ratio * 0.4;  // the rest stands at half height
    r.cover = cover;
    r.stirrups = stirrups;
    return r;
  }

  void add_column(int k, int i, int j) {
    const double clear = b_.storey_height - b_.beam_depth, bottom = k * b_.storey_height;
    Member& column = add(name_of("column", k, i, j), MemberKind::column,
                         {x_of(i), y_of(j), bottom + clear / 2}, {b_.column, b_.column, clear}, concrete_);
    column.cut.counts[2] = count(clear);
    column.cut.slope = kColumnSlope;
    column.bars = bars(b_.column_bars, kStirrups, 0.05);
    Member& head = add(name_of("column head", k, i, j), MemberKind::column,
                       {x_of(i), y_of(j), top_of(k) - b_.beam_depth / 2},
                       {b_.column, b_.column, b_.beam_depth}, concrete_);
    head.bars = bars(b_.column_bars, kStirrups, 0.05);
    head.variant = 0;
  }

  void add_beam(int k, int i, int j, bool along_x) {
    const double clear = (along_x ? b_.span_x : b_.span_y) - b_.column;
    const double x = along_x ? x_of(i + 0.5) : x_of(i), y = along_x ? y_of(j) : y_of(j + 0.5);
    const Vec3 size = along_x ? Vec3{clear, b_.column, b_.beam_depth} : Vec3{b_.column, clear, b_.beam_depth};
    Member& beam = add(name_of(along_x ? "beam along X" : "beam along Y", k, i, j), MemberKind::beam,
                       {x, y, top_of(k) - b_.beam_depth / 2}, size, concrete_);
    beam.cut.counts[along_x ? 0 : 1] = count(clear);
    beam.bars = bars(b_.beam_bars, kStirrups, 0.05);
  }

  void add_slab(int k, int i, int j) {
    const Vec3 size{b_.span_x - b_.column, b_.span_y - b_.column, b_.slab};
    Member& slab = add(name_of("slab", k, i, j), MemberKind::slab,
                       {x_of(i + 0.5), y_of(j + 0.5), top_of(k) - b_.slab / 2}, size, concrete_);
    slab.cut.counts[0] = count(size.x);
    slab.cut.counts[1] = count(size.y);
    slab.bars = bars(b_.slab_bars, kDowels, 0.03);
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
      Member& wall = add(name_of(along_x ? "wall along X" : "wall along Y", k, i, j), MemberKind::wall,
                         centre, size, masonry());
      wall.cut.counts[along_x ? 0 : 1] = count(l);
      wall.cut.counts[2] = count(h);
      wall.stiffness = kInfillStiffness;
    };
    const double half = length / 2;
    if (!(open > 0.2)) return panel(-half, half, 0, height);
    panel(-half, -half + side, 0, height);
    panel(half - side, half, 0, height);
    panel(-half + side, half - side, 0, sill);
    panel(-half + side, half - side, head, height);
  }

  const StructuralMaterial& masonry() const {
    return find_structural_material(b_.infill == Infill::block ? "block_masonry" : "brick_masonry",
                                    "building.infill");
  }

  const BuildingSpec& b_;
  RandomStream random_;
  StructuralMaterial concrete_;
  std::vector<Member> members_;
};

bool ends_with_storey(const std::string& name, int storey) {
  const std::string end = " of storey " + std::to_string(storey);
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

// A soft storey is open: walls would carry what its columns do not.
bool is_removed(const BuildingSpec& b, const Member& member) {
  if (member.kind == MemberKind::wall && ends_with_storey(member.name, b.cause.weak_storey)) return true;
  return std::any_of(b.cause.removed.begin(), b.cause.removed.end(), [&](const ColumnPlace& c) {
    return member.name == name_of("column", c.storey, c.i, c.j);
  });
}

void weaken(Section& s, double share) {
  s.compression *= share, s.tension *= share, s.shear *= share;
  s.steel.yield *= share, s.steel.stirrups *= share;
}

// A floor's overload is carried, and falls, with its slabs: they become denser.
void add_overload(const BuildingSpec& b, Structure& s) {
  const double denser = b.cause.overload / b.slab;
  std::map<std::int32_t, std::int32_t> heavy;
  for (StructurePiece& piece : s.pieces) {
    const Member& member = s.members[piece.member];
    if (member.kind != MemberKind::slab || !ends_with_storey(member.name, b.cause.overloaded_floor)) continue;
    const auto [at, is_new] = heavy.insert({piece.type, std::int32_t(s.types.size())});
    if (is_new) {
      PieceType type = s.types[piece.type];
      type.name += "_loaded";
      type.density += denser;
      s.types.push_back(type);
      s.type_materials.push_back(s.type_materials[piece.type]);
      s.type_bars.push_back(s.type_bars[piece.type]);
    }
    const double ratio = s.types[at->second].density / s.types[piece.type].density;
    piece.type = at->second;
    piece.mass *= ratio;
    piece.inertia = piece.inertia * ratio;
  }
}

}  // namespace

void validate(const BuildingSpec& b) {
  const CollapseCause& c = b.cause;
  const Range ranges[] = {
      {"storeys", double(b.storeys), 1, 12},       {"bays_x", double(b.bays_x), 1, 8},
      {"bays_y", double(b.bays_y), 1, 8},          {"span_x", b.span_x, 2, 12},
      {"span_y", b.span_y, 2, 12},                 {"storey_height", b.storey_height, 2.2, 6},
      {"column", b.column, 0.15, 1.2},             {"beam_depth", b.beam_depth, 0.15, 1.5},
      {"slab", b.slab, 0.1, 0.5},                  {"column_bars", b.column_bars, 0, 0.06},
      {"beam_bars", b.beam_bars, 0, 0.06},         {"slab_bars", b.slab_bars, 0, 0.06},
      {"infill_thickness", b.infill_thickness, 0.08, 0.5}, {"openings", b.openings, 0, 0.8},
      {"piece", b.piece, 0.3, 3},                  {"roughness", b.roughness, 0, 0.45},
      {"continuity", b.continuity, 0, 1},          {"vehicle.mass", c.vehicle.mass, 0, 1e5},
      {"vehicle.speed", c.vehicle.speed, 0, 60},   {"vehicle.stiffness", c.vehicle.stiffness, 1e4, 1e7},
      {"vehicle.height", c.vehicle.height, 0.2, 3}, {"vehicle.i", double(c.vehicle.i), 0, double(b.bays_x)},
      {"vehicle.j", double(c.vehicle.j), 0, double(b.bays_y)},
      {"accelerogram_step", c.accelerogram_step, 0.001, 1},
      {"accelerogram", double(c.accelerogram.size()), 0, 200000},
      {"weakness", c.weakness, 0, 1},              {"overload", c.overload, 0, 3000},
      {"shake", c.shake, 0, 20},                   {"shake_hz", c.shake_hz, 0.2, 20},
      {"shake_seconds", c.shake_seconds, 1, 60},   {"blast", c.blast, 0, 1e6},
      {"weak_storey", double(c.weak_storey), -1, b.storeys - 1.0},
      {"overloaded_floor", double(c.overloaded_floor), -1, b.storeys - 1.0},
  };
  std::vector<Diagnostic> problems;
  const auto fail = [&](const std::string& key, const std::string& expected, const std::string& found) {
    problems.push_back({"", 0, "pile.building." + key, "out of range", expected, found, ""});
  };
  for (const Range& r : ranges) {
    if (r.value >= r.low && r.value <= r.high) continue;
    fail(r.key, std::to_string(r.low) + " to " + std::to_string(r.high), std::to_string(r.value));
  }
  if (b.slab > b.beam_depth) fail("slab", "not more than beam_depth", std::to_string(b.slab));
  if (b.infill_thickness > b.column) fail("infill_thickness", "not more than column", std::to_string(b.infill_thickness));
  for (const ColumnPlace& p : c.removed) {
    const bool fine = p.storey >= 0 && p.storey < b.storeys && p.i >= 0 && p.i <= b.bays_x &&
                      p.j >= 0 && p.j <= b.bays_y;
    if (!fine) fail("removed", "a column of the building", name_of("column", p.storey, p.i, p.j));
  }
  for (const SinkingFooting& f : c.sinking) {
    const bool fine = f.i >= 0 && f.i <= b.bays_x && f.j >= 0 && f.j <= b.bays_y && f.depth >= 0 && f.depth <= 2;
    if (!fine) fail("sinking", "a ground column of the building, 0 to 2 m", name_of("column", 0, f.i, f.j));
  }
  if (!problems.empty()) throw InputError(problems);
}

bool is_ground_column(const Member& member, int i, int j) { return member.name == name_of("column", 0, i, j); }

Structure build_building(const BuildingSpec& building) {
  return build_structure(FrameMaker(building).make(), building.seed);
}

Structure build_damaged(const BuildingSpec& b, const Structure& whole) {
  Structure damaged = whole;
  damaged.pieces.clear(), damaged.bonds.clear();
  std::vector<std::int32_t> number(whole.pieces.size(), -2);
  for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
    if (is_removed(b, whole.members[whole.pieces[i].member])) continue;
    number[i] = std::int32_t(damaged.pieces.size());
    damaged.pieces.push_back(whole.pieces[i]);
  }
  for (const Bond& bond_before : whole.bonds) {
    Bond bond = bond_before;
    const Member& one = whole.members[whole.pieces[bond.piece_a].member];
    const Member& other =
        bond.piece_b == kFoundation ? one : whole.members[whole.pieces[bond.piece_b].member];
    bond.piece_a = number[bond.piece_a];
    bond.piece_b = bond.piece_b == kFoundation ? kFoundation : number[bond.piece_b];
    if (bond.piece_a == -2 || bond.piece_b == -2) continue;
    const auto is_weak = [&](const Member& m) {
      return m.kind == MemberKind::column && ends_with_storey(m.name, b.cause.weak_storey);
    };
    if (is_weak(one) || is_weak(other)) weaken(bond.section, b.cause.weakness);
    damaged.bonds.push_back(bond);
    damaged.from_bond.push_back(std::int32_t(&bond_before - whole.bonds.data()));
  }
  if (b.cause.overloaded_floor >= 0 && b.cause.overload > 0) add_overload(b, damaged);
  return damaged;
}

}  // namespace rubble
