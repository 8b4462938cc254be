// Walls of masonry on all grid lines, with windows outside and doors inside, that carry floors of timber
// joists and boards.
#include <algorithm>
#include <cmath>

#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

constexpr double kLeastCourses = 0.3;  // of bricks above a lintel; unit: m

class MasonryMaker {
 public:
  explicit MasonryMaker(const BuildingSpec& b) : b_(b), material_(material_of(b.infill)) {}

  std::vector<Member> make() {
    for (int k = 0; k < b_.storeys; ++k) {
      visit_grid(b_, [&](int i, int j) { add_corner(k, i, j); },
                 [&](int i, int j, bool along_x) { add_wall(k, i, j, along_x); },
                 [&](int i, int j) { add_floor(k, i, j); });
    }
    add_parapet(b_, b_.wall, parts_);
    RandomStream random(b_.seed, "building parts");
    return resolve_parts(std::move(parts_), b_, random);
  }

 private:
  double bottom_of(int k) const { return k * b_.storey_height; }

  BuildingPart& add(const std::string& name, int k, const Aabb& box) {
    BuildingPart part;
    part.member.name = name;
    part.member.kind = MemberKind::wall;
    part.member.material = material_;
    part.member.place = {k, -1, -1, "", false, true};
    part.rank = kWallRank;
    set_box(part.member, box);
    parts_.push_back(part);
    return parts_.back();
  }

  void add_corner(int k, int i, int j) {
    const double x = x_of(b_, i), y = y_of(b_, j), half = b_.wall / 2;
    MemberPlace& place = add(place_name("wall corner", k, i, j), k,
                             {{x - half, y - half, bottom_of(k)}, {x + half, y + half, bottom_of(k + 1)}})
                             .member.place;
    place.i = i, place.j = j;
  }

  // From corner to corner; each half belongs to its corner, an opening and what is above it to neither.
  void add_wall(int k, int i, int j, bool along_x) {
    const double from = (along_x ? x_of(b_, i) : y_of(b_, j)) + b_.wall / 2;
    const double to = (along_x ? x_of(b_, i + 1) : y_of(b_, j + 1)) - b_.wall / 2;
    const double across = along_x ? y_of(b_, j) : x_of(b_, i), half = b_.wall / 2;
    const double low = bottom_of(k), high = bottom_of(k + 1), middle = (from + to) / 2;
    const auto box = [&](double u, double v, double z0, double z1) {
      return along_x ? Aabb{{u, across - half, z0}, {v, across + half, z1}}
                     : Aabb{{across - half, u, z0}, {across + half, v, z1}};
    };
    const bool outside = along_x ? j == 0 || j == b_.bays_y : i == 0 || i == b_.bays_x;
    double open = outside ? (to - from) * b_.openings : kDoorWidth;
    if (!(b_.openings > 0) || open < 0.3) open = 0;
    const std::string name = along_x ? "wall along X" : "wall along Y";
    const auto side = [&](double u, double v, int di) {
      const int at_i = i + (along_x ? di : 0), at_j = j + (along_x ? 0 : di);
      MemberPlace& place = add(place_name(name, k, i, j), k, box(u, v, low, high)).member.place;
      place.i = at_i, place.j = at_j;
    };
    side(from, middle - open / 2, 0);
    side(middle + open / 2, to, 1);
    if (open == 0) return;
    const double sill = low + (outside ? b_.storey_height * kWindowSill : 0);
    const double head = low + (outside ? b_.storey_height * kWindowHead : kDoorHeight);
    const double u = middle - open / 2, v = middle + open / 2;
    if (sill > low) add(place_name(name, k, i, j), k, box(u, v, low, sill));
    add(place_name(name, k, i, j), k, box(u, v, head, high));
    parts_.push_back(make_lintel(place_name("lintel of the " + name, k, i, j), k,
                                 box(u - kLintelBears, v + kLintelBears, head, lintel_top(head, high))));
  }

  // What would be left of the wall below the joists is cast in one with the lintel.
  double lintel_top(double head, double high) const {
    const double joists = high - kBoards - b_.joist_depth;
    const double rest = joists - head - kLintel;
    return rest > -0.05 && rest < kLeastCourses ? joists : head + kLintel;
  }

  void add_floor(int k, int i, int j) {
    const double half = b_.wall / 2;
    const Aabb room{{x_of(b_, i) + half, y_of(b_, j) + half, bottom_of(k)},
                    {x_of(b_, i + 1) - half, y_of(b_, j + 1) - half, bottom_of(k + 1)}};
    add_timber_floor(b_, room, half, place_name("floor", k, i, j), k, "", parts_);
  }

  const BuildingSpec& b_;
  StructuralMaterial material_;
  std::vector<BuildingPart> parts_;
};

}  // namespace

std::vector<Member> make_masonry(const BuildingSpec& building) { return MasonryMaker(building).make(); }

}  // namespace rubble
