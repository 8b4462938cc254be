#include "assets/generator/shapes.h"

#include <cmath>

namespace rubble::generator {
namespace {

constexpr double kBuried = 0.08;      // of a bar within the concrete; unit: m
constexpr double kShortest = 0.05;    // a bar that collides; unit: m
constexpr double kBrokenShort = 0.4;  // share of bars broken off short

}  // namespace

RandomStream piece_stream(const std::string& name) { return {2024, "assets/" + name}; }

std::vector<Vec3> box_corners(const Vec3& min, const Vec3& max) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z});
  }
  return corners;
}

Recipe concrete_recipe(const std::string& name, RandomStream& random) {
  Recipe r;
  r.name = name;
  r.solid.seed = static_cast<std::uint32_t>(random.next() >> 40);
  return r;
}

double exit_distance(const Cell& cell, const Vec3& from, const Vec3& direction) {
  double nearest = 1e9;
  for (const Face& face : cell) {
    const double speed = dot(face.normal, direction);
    if (!face.round && speed > 1e-6) {
      nearest = std::fmin(nearest, (face.offset - dot(face.normal, from)) / speed);
    }
  }
  return nearest;
}

Bar protruding_bar(const Cell& cell, const Vec3& through, const Vec3& direction, double radius,
                   RandomStream& random) {
  const Vec3 exit = through + direction * exit_distance(cell, through, direction);
  const Vec3 start = exit - direction * kBuried;
  Bar bar;
  bar.radius = radius;
  bar.hidden = kBuried;
  if (random.uniform() < kBrokenShort) {
    bar.line = {start, exit + direction * random.uniform(0.015, kShortest - 0.005)};
    bar.collides = false;
    return bar;
  }
  const Vec3 knee = exit + direction * random.uniform(0.04, 0.10);
  const double sideways = random.uniform(0.3, 0.9);  // one draw a statement: C++ fixes no order
  const Vec3 bent = normalized(direction + random.direction() * sideways);
  bar.line = {start, knee, knee + bent * random.uniform(0.05, 0.16)};
  return bar;
}

}  // namespace rubble::generator
