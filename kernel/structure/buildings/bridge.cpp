// A bridge: girders along X under a deck slab, simply supported on caps over rows of columns and on abutments.
#include <algorithm>
#include <cmath>

#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

constexpr double kGirderWidth = 0.5;     // of the columns' width; unit: 1
constexpr double kCapDepth = 0.9;        // of the columns' width; unit: 1
constexpr double kCapOverhang = 0.1;     // beyond the columns, on either side; unit: m
constexpr double kSpansApart = 0.02;     // from the axis of a pier; unit: m
constexpr double kAbutment = 1.2;        // thickness; unit: m
constexpr double kDeckOverhang = 0.8;    // beyond the outer girders; unit: m
constexpr double kPad = 0.1;             // height of a bearing; unit: m
constexpr double kPadLength = 0.3;       // along the girder; unit: m
constexpr double kParapetThick = 0.25;   // of a parapet; unit: m
constexpr double kAbutmentBars = 0.003;  // share of the section; unit: 1

class BridgeMaker {
 public:
  explicit BridgeMaker(const BuildingSpec& b)
      : b_(b), concrete_(find_structural_material("concrete", "building.material")) {}

  std::vector<Member> make() {
    for (int i = 0; i <= b_.bays_x; ++i) i == 0 || i == b_.bays_x ? add_abutment(i) : add_pier(i);
    for (int i = 0; i < b_.bays_x; ++i) add_span(i);
    RandomStream random(b_.seed, "building parts");
    return resolve_parts(std::move(parts_), b_, random);
  }

 private:
  double soffit() const { return b_.storey_height - b_.beam_depth; }  // of the girders
  double seat() const { return soffit() - kPad; }                     // upper side of caps and abutments
  double y_low() const { return y_of(b_, 0) - b_.column / 2 - kCapOverhang; }
  double y_high() const { return y_of(b_, b_.bays_y) + b_.column / 2 + kCapOverhang; }

  Member& add(const std::string& name, MemberKind kind, const Aabb& box, double ratio, double stirrups) {
    BuildingPart part;
    part.member.name = name;
    part.member.kind = kind;
    part.member.material = concrete_;
    part.member.bars = make_bars(ratio, stirrups, 0.05);
    part.member.place.storey = 0;
    set_box(part.member, box);
    parts_.push_back(part);
    return parts_.back().member;
  }

  void add_abutment(int i) {
    const double x = x_of(b_, i), out = i == 0 ? -1 : 1;
    const double inner = x - out * (b_.column / 2 + kCapOverhang), outer = x + out * kAbutment;
    add(place_name("abutment", 0, i, 0), MemberKind::wall,
        {{std::min(inner, outer), y_low(), 0}, {std::max(inner, outer), y_high(), seat()}}, kAbutmentBars, kDowels);
  }

  void add_pier(int i) {
    const double half = b_.column / 2, x = x_of(b_, i), cap = seat() - kCapDepth * b_.column;
    for (int j = 0; j <= b_.bays_y; ++j) {
      const double y = y_of(b_, j);
      Member& column = add(place_name("column", 0, i, j), MemberKind::column,
                           {{x - half, y - half, 0}, {x + half, y + half, cap}}, b_.column_bars, kStirrups);
      column.place.i = i, column.place.j = j, column.place.bearing = true;
    }
    add(place_name("cap", 0, i, 0), MemberKind::beam,
        {{x - half - kCapOverhang, y_low(), cap}, {x + half + kCapOverhang, y_high(), seat()}}, b_.beam_bars, kStirrups);
  }

  // Place of the bearing on line i of the girders of a span; unit: m.
  double bearing(int i, int span) const {
    const double off = i == 0 || i == b_.bays_x ? 0 : (b_.column / 2 + kCapOverhang) / 2;
    return x_of(b_, i) + (i == span ? off : -off);
  }

  void add_span(int i) {
    const double width = kGirderWidth * b_.column, top = b_.storey_height;
    const double x0 = i == 0 ? x_of(b_, i) - b_.column / 2 : x_of(b_, i) + kSpansApart;
    const double x1 = i + 1 == b_.bays_x ? x_of(b_, i + 1) + b_.column / 2 : x_of(b_, i + 1) - kSpansApart;
    for (int j = 0; j <= b_.bays_y; ++j) {
      const double y = y_of(b_, j);
      Member& girder = add(place_name("girder", 0, i, j), MemberKind::beam,
                           {{x0, y - width / 2, soffit()}, {x1, y + width / 2, top - b_.slab}}, b_.beam_bars, kStirrups);
      girder.joint = MemberJoint::seated;
      girder.span_axis = 0;
      for (const bool first : {true, false}) {
        const double x = first ? bearing(i, i) : bearing(i + 1, i);
        add(place_name("bearing", 0, i, j), MemberKind::beam,
            {{x - kPadLength / 2, y - width / 2, seat()}, {x + kPadLength / 2, y + width / 2, soffit()}}, b_.beam_bars,
            kStirrups);
      }
    }
    const double low = y_of(b_, 0) - kDeckOverhang, high = y_of(b_, b_.bays_y) + kDeckOverhang;
    add(place_name("deck", 0, i, 0), MemberKind::slab, {{x0, low, top - b_.slab}, {x1, high, top}}, b_.slab_bars,
        kDowels);
    if (!(b_.parapet > 0)) return;
    for (const double y : {low, high - kParapetThick}) {
      add(place_name("parapet", 0, i, 0), MemberKind::wall, {{x0, y, top}, {x1, y + kParapetThick, top + b_.parapet}}, 0.004,
          kDowels)
          .place.storey = 1;
    }
  }

  const BuildingSpec& b_;
  StructuralMaterial concrete_;
  std::vector<BuildingPart> parts_;
};

}  // namespace

std::vector<Member> make_bridge(const BuildingSpec& building) { return BridgeMaker(building).make(); }

}  // namespace rubble
