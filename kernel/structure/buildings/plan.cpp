// A building as its plan draws it: walls along lines, columns, beams, slabs, timber floors, windows, holes.
#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

constexpr double kMostLintel = 0.9;     // what is lower between a window and the ceiling is cast in one; unit: m
constexpr double kLeastSpandrel = 0.1;  // above a window; lower ones are left out; unit: m

// Drawings carry more digits than builders measure: to 1 mm, so that faces meet.
double rounded(double x) { return std::round(x * 1000) / 1000; }

[[noreturn]] void refuse(std::size_t index, const PlanPart& part, const std::string& what, const std::string& expected,
                         const std::string& found, const std::string& hint) {
  throw InputError({"", 0, "pile.building.plan.parts[" + std::to_string(index + 1) + "]",
                    (part.name.empty() ? std::string() : part.name + ": ") + what, expected, found, hint});
}

const char* kind_name(PlanKind kind) {
  switch (kind) {
    case PlanKind::wall: return "wall";
    case PlanKind::column: return "column";
    case PlanKind::beam: return "beam";
    case PlanKind::slab: return "slab";
    case PlanKind::joists: return "joists";
    case PlanKind::window: return "window";
    case PlanKind::hole: return "hole";
  }
  return "part";
}

const StructuralMaterial& material_of(PlanMaterial material) {
  static const char* const kNames[] = {"concrete", "brick_masonry", "block_masonry", "timber"};
  return find_structural_material(kNames[int(material)], "pile.building.plan.parts.material");
}

class PlanMaker {
 public:
  explicit PlanMaker(const BuildingSpec& b) : b_(b) {}

  std::vector<Member> make() {
    double bottom = 0;
    for (int k = 0; k < int(b_.plan.heights.size()); ++k) {
      low_ = bottom, high_ = bottom + rounded(b_.plan.heights[k]);
      add_storey(k);
      bottom = high_;
    }
    RandomStream random(b_.seed, "building parts");
    return resolve_parts(std::move(parts_), b_, random);
  }

 private:
  static bool is_in(const PlanPart& part, int k) { return part.lowest <= k && k <= part.highest; }

  std::string name_of(std::size_t index) const {
    const PlanPart& part = b_.plan.parts[index];
    return part.name.empty() ? std::string(kind_name(part.kind)) + " " + std::to_string(index + 1) : part.name;
  }

  double bars_of(const PlanPart& part) const {
    if (part.bars >= 0) return part.bars;
    if (part.material != PlanMaterial::concrete) return 0;
    switch (part.kind) {
      case PlanKind::column: return b_.column_bars;
      case PlanKind::beam: return b_.beam_bars;
      default: return b_.slab_bars;
    }
  }

  BuildingPart make_part(std::size_t index, int k, MemberKind kind, int rank, const Aabb& box) const {
    const PlanPart& part = b_.plan.parts[index];
    const bool slender = kind == MemberKind::column || kind == MemberKind::beam;
    BuildingPart made;
    made.member.name = name_of(index) + " of storey " + std::to_string(k);
    made.member.kind = kind;
    made.member.material = material_of(part.material);
    const double ratio = bars_of(part);
    if (ratio > 0) made.member.bars = make_bars(ratio, slender ? kStirrups : kDowels, slender ? 0.05 : 0.03);
    made.member.place.storey = k;
    made.member.place.part = name_of(index);
    made.rank = rank;
    set_box(made.member, box);
    return made;
  }

  // The line with its width, and at corners as far as the walls across it are thick.
  Aabb strip(std::size_t index, double low, double high, int k) const {
    const PlanPart& p = b_.plan.parts[index];
    const double x1 = rounded(std::min(p.x1, p.x2)), x2 = rounded(std::max(p.x1, p.x2));
    const double y1 = rounded(std::min(p.y1, p.y2)), y2 = rounded(std::max(p.y1, p.y2));
    const bool along_x = x2 - x1 > y2 - y1;
    if ((along_x ? y2 - y1 : x2 - x1) > 1e-9) {
      refuse(index, p, std::string("a ") + kind_name(p.kind) + " that is neither along X nor along Y",
             "two ends with the same x or the same y", found_line(p), "turn the drawing until walls lie along its axes");
    }
    if (!((along_x ? x2 - x1 : y2 - y1) > 0.05)) {
      refuse(index, p, std::string("a ") + kind_name(p.kind) + " without a length", "two ends more than 5 cm apart",
             found_line(p), "");
    }
    const double half = rounded(p.thickness) / 2;
    Aabb box = along_x ? Aabb{{x1, y1 - half, low}, {x2, y1 + half, high}}
                       : Aabb{{x1 - half, y1, low}, {x1 + half, y2, high}};
    if (p.kind == PlanKind::window) return box;
    const int axis = along_x ? 0 : 1;
    box.min[axis] -= reach(index, along_x ? x1 : y1, along_x ? y1 : x1, along_x, k);
    box.max[axis] += reach(index, along_x ? x2 : y2, along_x ? y1 : x1, along_x, k);
    return box;
  }

  // Half the thickness of what crosses the end of a line there.
  double reach(std::size_t index, double end, double across, bool along_x, int k) const {
    double most = 0;
    for (std::size_t i = 0; i < b_.plan.parts.size(); ++i) {
      const PlanPart& o = b_.plan.parts[i];
      if (i == index || o.kind != b_.plan.parts[index].kind || !is_in(o, k)) continue;
      const double at = along_x ? o.x1 : o.y1, also = along_x ? o.x2 : o.y2;
      const double from = along_x ? std::min(o.y1, o.y2) : std::min(o.x1, o.x2);
      const double to = along_x ? std::max(o.y1, o.y2) : std::max(o.x1, o.x2);
      const double near = 1e-3 + o.thickness / 2;
      if (std::abs(at - also) > 1e-9 || std::abs(at - end) > 1e-3 || across < from - near || across > to + near) continue;
      most = std::max(most, rounded(o.thickness) / 2);
    }
    return most;
  }

  Aabb rectangle(std::size_t index, double low, double high) const {
    const PlanPart& p = b_.plan.parts[index];
    const Aabb box{{rounded(std::min(p.x1, p.x2)), rounded(std::min(p.y1, p.y2)), low},
                   {rounded(std::max(p.x1, p.x2)), rounded(std::max(p.y1, p.y2)), high}};
    if (box.max.x - box.min.x < 0.05 || box.max.y - box.min.y < 0.05) {
      refuse(index, p, std::string("a ") + kind_name(p.kind) + " without an area", "two corners more than 5 cm apart",
             found_line(p), "");
    }
    return box;
  }

  static std::string found_line(const PlanPart& p) {
    char text[120];
    std::snprintf(text, sizeof text, "(%g, %g) to (%g, %g)", p.x1, p.y1, p.x2, p.y2);
    return text;
  }

  void add_storey(int k) {
    const std::size_t first = parts_.size();
    for (std::size_t i = 0; i < b_.plan.parts.size(); ++i) {
      if (is_in(b_.plan.parts[i], k)) add(i, k);
    }
    for (std::size_t i = 0; i < b_.plan.parts.size(); ++i) {
      const PlanPart& p = b_.plan.parts[i];
      if (!is_in(p, k)) continue;
      if (p.kind == PlanKind::window) open_walls(i, k, first);
      if (p.kind == PlanKind::hole) open_floors(i, first);
    }
  }

  void add(std::size_t i, int k) {
    const PlanPart& p = b_.plan.parts[i];
    const double top = p.top > 0 ? std::min(low_ + rounded(p.top), high_) : high_;
    switch (p.kind) {
      case PlanKind::wall: {
        BuildingPart wall = make_part(i, k, MemberKind::wall, kWallRank, strip(i, low_ + rounded(p.bottom), top, k));
        wall.member.place.bearing = true;
        return parts_.push_back(wall);
      }
      case PlanKind::column: {
        BuildingPart column = make_part(i, k, MemberKind::column, kColumnRank, rectangle(i, low_, high_));
        column.member.place.bearing = true;
        return parts_.push_back(column);
      }
      case PlanKind::beam: {
        return parts_.push_back(
            make_part(i, k, MemberKind::beam, kBeamRank, strip(i, high_ - rounded(p.depth), high_, k)));
      }
      case PlanKind::slab:
        return parts_.push_back(
            make_part(i, k, MemberKind::slab, kSlabRank, rectangle(i, high_ - rounded(p.thickness), high_)));
      case PlanKind::joists: {
        BuildingSpec floor = b_;
        floor.joist_depth = rounded(p.thickness);
        return add_timber_floor(floor, rectangle(i, low_, high_), 0, name_of(i) + " of storey " + std::to_string(k), k,
                                name_of(i), parts_);
      }
      default: return;
    }
  }

  // In all walls whose axis it lies on.
  void open_walls(std::size_t index, int k, std::size_t first) {
    const PlanPart& p = b_.plan.parts[index];
    const double head = std::min(high_, low_ + rounded(p.top)), sill = low_ + rounded(p.bottom);
    if (!(sill < head)) {
      refuse(index, p, "a window without a height", "sill below head", plain_text(p.bottom), "");
    }
    Aabb box = strip(index, sill, head, k);
    const int across = box.max.x - box.min.x > box.max.y - box.min.y ? 1 : 0, along = 1 - across;
    const double axis = (box.min[across] + box.max[across]) / 2;
    bool found = false;
    const std::size_t count = parts_.size();
    for (std::size_t i = first; i < count; ++i) {
      const Aabb wall = box_of(parts_[i].member);
      if (parts_[i].member.kind != MemberKind::wall || axis < wall.min[across] || axis > wall.max[across]) continue;
      if (box.max[along] <= wall.min[along] + 1e-4 || box.min[along] >= wall.max[along] - 1e-4) continue;
      if (wall.max[along] - wall.min[along] < wall.max[across] - wall.min[across]) continue;
      found = true;
      Aabb hole = box;
      hole.min[across] = wall.min[across], hole.max[across] = wall.max[across];
      parts_[i].holes.push_back(hole);
      const double ceiling = wall.max.z;
      if (ceiling - head < kLeastSpandrel || parts_[i].member.bars.ratio > 0) continue;
      Aabb lintel = hole;
      lintel.min[along] = std::max(wall.min[along], hole.min[along] - kLintelBears);
      lintel.max[along] = std::min(wall.max[along], hole.max[along] + kLintelBears);
      lintel.min.z = head, lintel.max.z = ceiling - head < kMostLintel ? ceiling : head + kLintel;
      parts_.push_back(make_lintel("lintel of " + name_of(index) + " of storey " + std::to_string(k), k, lintel));
    }
    if (!found) {
      refuse(index, p, "a window in no wall", "a line on the axis of a wall of its storeys", found_line(p),
             "draw it along the wall, or give it the storeys that have the wall");
    }
  }

  void open_floors(std::size_t index, std::size_t first) {
    const Aabb hole = rectangle(index, low_, high_ + 0.01);
    bool found = false;
    for (std::size_t i = first; i < parts_.size(); ++i) {
      const Member& member = parts_[i].member;
      const bool floor = member.kind == MemberKind::slab || member.joint == MemberJoint::seated;
      if (!floor || !overlap(box_of(member), hole)) continue;
      parts_[i].holes.push_back(hole);
      found = true;
    }
    if (!found) {
      refuse(index, b_.plan.parts[index], "a hole in no floor", "a rectangle within a slab or joists",
             found_line(b_.plan.parts[index]), "");
    }
  }

  const BuildingSpec& b_;
  double low_ = 0, high_ = 0;  // of the storey; unit: m
  std::vector<BuildingPart> parts_;
};

}  // namespace

std::vector<Member> make_planned(const BuildingSpec& building) { return PlanMaker(building).make(); }

}  // namespace rubble
