#include "kernel/settling/furnish.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr double kClearance = 0.06;  // from columns, walls and other pieces; unit: m
constexpr double kLift = 0.002;      // above the floor: twice the gap at which pieces rest; unit: m
constexpr double kAlongASide = 0.7;  // share of pieces that stand along a side of their bay; unit: 1
constexpr double kTurn = 4;          // standard deviation from the directions of the bay; unit: degrees
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
  Furnisher(const PileSpec& spec, const std::vector<Aabb>& bounds)
      : b_(spec.building), spec_(spec), bounds_(bounds), random_(spec.seed, "furniture") {}

  std::vector<Placement> furnish() {
    check();
    for (int storey = 0; storey <= b_.storeys; ++storey) {
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
    const double edge = b_.column / 2 + kClearance;
    const double x = (i - b_.bays_x / 2.0) * b_.span_x, y = (j - b_.bays_y / 2.0) * b_.span_y;
    const Footprint room{x + edge, x + b_.span_x - edge, y + edge, y + b_.span_y - edge};
    for (const Furnishing& item : spec_.furniture) {
      const int count = int(std::floor(item.per_bay + random_.uniform()));
      for (int k = 0; k < count; ++k) {
        if (floor == b_.storeys && !item.roof) continue;
        place(item, room, floor * b_.storey_height + kLift);
      }
    }
  }

  void place(const Furnishing& item, const Footprint& room, double z) {
    for (int t = 0; t < kTries; ++t) {
      const double yaw = (90 * double(random_.below(4)) + kTurn * random_.normal()) * portable::kPi / 180;
      const Aabb& e = bounds_[item.type];
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
      taken_.push_back(print);
      Placement placement;
      placement.type = item.type;
      placement.world_from_body = {turned, {print.x0 - low.x, print.y0 - low.y, z - e.min.z}};
      placed_.push_back(placement);
      return;
    }
  }

  void check() const {
    const double height = b_.storey_height - b_.beam_depth - kClearance;
    for (std::size_t i = 0; i < spec_.furniture.size(); ++i) {
      const Aabb& e = bounds_[spec_.furniture[i].type];
      const Vec3 size = e.max - e.min;
      const double clear = b_.column + 2 * kClearance;
      const double across = std::min(b_.span_x, b_.span_y) - clear, along = std::max(b_.span_x, b_.span_y) - clear;
      const auto refuse = [i](const std::string& expected, double found) {
        throw InputError({"", 0, "pile.building.furniture[" + std::to_string(i + 1) + "].asset",
                          "does not fit into the building", expected, std::to_string(found) + " m",
                          "take smaller assets, or a building with higher storeys or larger spans"});
      };
      if (size.z > height) refuse("lower than " + std::to_string(height) + " m, below the beams", size.z);
      if (std::min(size.x, size.y) > across) {
        refuse("narrower than " + std::to_string(across) + " m, between the columns", std::min(size.x, size.y));
      }
      if (std::max(size.x, size.y) > along) {
        refuse("shorter than " + std::to_string(along) + " m, between the columns", std::max(size.x, size.y));
      }
    }
  }

  const BuildingSpec& b_;
  const PileSpec& spec_;
  const std::vector<Aabb>& bounds_;
  RandomStream random_;
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

std::vector<Placement> furnish(const PileSpec& spec, const std::vector<Aabb>& bounds) {
  if (spec.furniture.empty() || !spec.building.given()) return {};
  return Furnisher(spec, bounds).furnish();
}

}  // namespace rubble
