#include "kernel/settling/furnish.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/structure/building.h"

namespace rubble {
namespace {

constexpr double kClearance = 0.06;  // from columns, walls and other pieces; unit: m
constexpr double kLift = 0.002;      // above the floor: twice the gap at which pieces rest; unit: m
constexpr double kAlongASide = 0.7;  // share of pieces that stand along a side of their bay; unit: 1
constexpr double kTurn = 4;          // standard deviation from the directions of the bay; unit: degrees
constexpr double kStanding = 1.5;    // what begins lower than this above a floor stands on it; unit: m
constexpr int kTries = 20;           // to find room in a bay

struct Footprint {
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;

  bool meets(const Footprint& other) const {
    return x0 < other.x1 + kClearance && other.x0 < x1 + kClearance && y0 < other.y1 + kClearance &&
           other.y0 < y1 + kClearance;
  }
};

class Furnisher {
 public:
  Furnisher(const PileSpec& spec, const ByKind<Aabb>& bounds)
      : b_(spec.building), spec_(spec), bounds_(bounds), random_(spec.seed, "furniture") {
    if (!b_.plain()) members_ = list_members(b_);
  }

  std::vector<Placement> furnish() {
    check();
    for (int storey = b_.kind == BuildingKind::bridge ? 1 : 0; storey <= b_.storeys; ++storey) {
      if (b_.planned()) {
        furnish_plan(storey);
        continue;
      }
      for (int i = 0; i < b_.bays_x; ++i) {
        for (int j = 0; j < b_.bays_y; ++j) furnish_bay(storey, i, j);
      }
    }
    return placed_;
  }

 private:
  // On a floor: 0 is the ground, the last one the roof.
  void furnish_bay(int floor, int i, int j) {
    taken_.clear();
    const double edge = (b_.kind == BuildingKind::masonry ? b_.wall : b_.column) / 2 + kClearance;
    const double x = (i - b_.bays_x / 2.0) * b_.span_x, y = (j - b_.bays_y / 2.0) * b_.span_y;
    Footprint room{x + edge, x + b_.span_x - edge, y + edge, y + b_.span_y - edge};
    if (b_.kind == BuildingKind::bridge) {  // a span is one bay
      if (j > 0) return;
      room.y1 = -y - edge;
    }
    take_members(floor * b_.storey_height);
    furnish_room(floor, room, floor * b_.storey_height);
  }

  // A whole floor of a plan is one bay; what stands there must lie on one of its floors.
  void furnish_plan(int floor) {
    double z = 0;
    for (int k = 0; k < floor; ++k) z += b_.plan.heights[k];
    taken_.clear();
    take_members(z);
    Footprint room{1e30, -1e30, 1e30, -1e30};
    for (const Member& m : members_) {
      const Vec3 low = m.centre - m.size * 0.5, high = m.centre + m.size * 0.5;
      if (m.kind != MemberKind::wall && m.kind != MemberKind::column) continue;
      room = {std::min(room.x0, low.x), std::max(room.x1, high.x), std::min(room.y0, low.y), std::max(room.y1, high.y)};
    }
    furnish_room(floor, room, z);
  }

  // Walls, columns and stairs that stand on a floor, and where it has holes.
  void take_members(double z) {
    floors_.clear();
    for (const Member& m : members_) {
      const Vec3 low = m.centre - m.size * 0.5, high = m.centre + m.size * 0.5;
      const Footprint print{low.x, high.x, low.y, high.y};
      if (m.kind == MemberKind::slab && std::abs(high.z - z) < 1e-6) floors_.push_back(print);
      const bool stands = low.z < z + kStanding && high.z > z + kLift;
      if (stands && m.kind != MemberKind::slab) taken_.push_back(print);
    }
  }

  // Whether its corners and its middle lie on a floor.
  bool is_on_floor(const Footprint& p) const {
    const auto carried = [this](double x, double y) {
      return std::any_of(floors_.begin(), floors_.end(),
                         [&](const Footprint& f) { return f.x0 <= x && x <= f.x1 && f.y0 <= y && y <= f.y1; });
    };
    return carried(p.x0, p.y0) && carried(p.x1, p.y0) && carried(p.x0, p.y1) && carried(p.x1, p.y1) &&
           carried((p.x0 + p.x1) / 2, (p.y0 + p.y1) / 2);
  }

  void furnish_room(int floor, const Footprint& room, double z) {
    for (const Furnishing& item : spec_.furniture) {
      const int count = int(std::floor(item.per_bay + random_.uniform()));
      for (int k = 0; k < count; ++k) {
        if (floor == b_.storeys && !item.roof) continue;
        place(item, room, z + kLift);
      }
    }
  }

  void place(const Furnishing& item, const Footprint& room, double z) {
    for (int t = 0; t < kTries; ++t) {
      const double quarter = 90 * double(random_.below(4));
      const double yaw = (quarter + kTurn * random_.normal()) * portable::kPi / 180;
      const Aabb& e = bounds_[item.kind];
      const Quat turned = portable::quat_from_rpy(0, 0, yaw);
      Aabb turned_bounds;
      for (const double x : {e.min.x, e.max.x}) {
        for (const double y : {e.min.y, e.max.y}) turned_bounds.include(turned.rotate({x, y, 0}));
      }
      const Vec3 low = turned_bounds.min, high = turned_bounds.max;
      const double free_x = room.x1 - room.x0 - (high.x - low.x), free_y = room.y1 - room.y0 - (high.y - low.y);
      if (free_x < 0 || free_y < 0) continue;
      double at_x = random_.uniform(0, free_x), at_y = random_.uniform(0, free_y);
      if (random_.uniform() < kAlongASide) {
        const int side = int(random_.below(4));
        if (side < 2) at_x = side * free_x;
        else at_y = (side - 2) * free_y;
      }
      const Footprint print{room.x0 + at_x, room.x0 + at_x + high.x - low.x, room.y0 + at_y,
                            room.y0 + at_y + high.y - low.y};
      if (std::any_of(taken_.begin(), taken_.end(), [&](const Footprint& f) { return f.meets(print); })) continue;
      if (b_.planned() && z > 2 * kLift && !is_on_floor(print)) continue;
      taken_.push_back(print);
      Placement placement;
      placement.kind = item.kind;
      placement.world_from_body = {turned, {print.x0 - low.x, print.y0 - low.y, z - e.min.z}};
      placed_.push_back(placement);
      return;
    }
  }

  void check() const {
    const double storey = b_.planned() ? *std::min_element(b_.plan.heights.begin(), b_.plan.heights.end()) : b_.storey_height;
    const double height = storey - b_.beam_depth - kClearance;
    for (std::size_t i = 0; i < spec_.furniture.size(); ++i) {
      const Aabb& e = bounds_[spec_.furniture[i].kind];
      const Vec3 size = e.max - e.min;
      const double clear = b_.column + 2 * kClearance;
      const double span_y = b_.kind == BuildingKind::bridge ? b_.bays_y * b_.span_y : b_.span_y;
      const double across = std::min(b_.span_x, span_y) - clear, along = std::max(b_.span_x, span_y) - clear;
      const auto refuse = [i](const std::string& expected, double found) {
        throw InputError({"", 0, "pile.building.furniture[" + std::to_string(i + 1) + "].asset",
                          "does not fit into the building", expected, brief_text(found) + " m",
                          "take smaller assets, or a building with higher storeys or larger spans"});
      };
      if (size.z > height) refuse("lower than " + brief_text(height) + " m, below the beams", size.z);
      if (b_.planned()) continue;
      if (std::min(size.x, size.y) > across) {
        refuse("narrower than " + brief_text(across) + " m, between the columns", std::min(size.x, size.y));
      }
      if (std::max(size.x, size.y) > along) {
        refuse("shorter than " + brief_text(along) + " m, between the columns", std::max(size.x, size.y));
      }
    }
  }

  const BuildingSpec& b_;
  const PileSpec& spec_;
  const ByKind<Aabb>& bounds_;
  RandomStream random_;
  std::vector<Member> members_;   // of other buildings than plain frames
  std::vector<Footprint> floors_;  // of a plan
  std::vector<Footprint> taken_;  // of the bay
  std::vector<Placement> placed_;
};

}  // namespace

Aabb calc_bounds(const PieceType& type) {
  Aabb bounds;
  for (const ConvexPart& part : type.parts) {
    for (const Vec3& point : part.points) bounds.include(point);
  }
  return bounds;
}

std::vector<Placement> furnish(const PileSpec& spec, const ByKind<Aabb>& bounds) {
  if (spec.furniture.empty() || !spec.building.given()) return {};
  return Furnisher(spec, bounds).furnish();
}

}  // namespace rubble
