#include "assets/generator/shapes.h"

#include <algorithm>
#include <cmath>

#include "assets/generator/polytope.h"

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

Cell extruded_cell(int axis, const Outline& outline, double low, double high, Surface surface) {
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  double area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    area += a[0] * b[1] - a[1] * b[0];
  }
  Vec3 along;
  along[axis] = 1;
  Cell cell{{along, high, surface}, {-along, -low, surface}};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    Vec3 normal;
    normal[u] = (b[1] - a[1]) * (area > 0 ? 1 : -1);
    normal[v] = (a[0] - b[0]) * (area > 0 ? 1 : -1);
    normal = normalized(normal);
    cell.push_back({normal, normal[u] * a[0] + normal[v] * a[1], surface});
  }
  return cell;
}

Cell cylinder_cell(int axis, const Vec3& centre, double radius, double low, double high,
                   Surface surface) {
  // Flat faces outside the round one keep the cell bounded.
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const double clear = 1.25 * radius + 0.05;
  Cell cell = extruded_cell(axis,
                            {{centre[u] - clear, centre[v] - clear},
                             {centre[u] + clear, centre[v] - clear},
                             {centre[u] + clear, centre[v] + clear},
                             {centre[u] - clear, centre[v] + clear}},
                            low, high, surface);
  Vec3 along;
  along[axis] = 1;
  cell.push_back({along, radius, surface, true, false, centre});
  return cell;
}

Wear timber_wear() { return {0.07, 0.030, 0.010, 0.0008, 0.004, 0.012, 0.07, 18}; }
Wear plywood_wear() { return {0.035, 0.022, 0.008, 0.0005, 0.003, 0.008, 0.05, 8}; }
Wear drywall_wear() { return {0.010, 0.045, 0.008, 0.0005, 0.003, 0.010, 0.04}; }
Wear steel_wear() { return {0.004, 0.05, 0.02, 0.0010, 0.006, 0, 0.12}; }
Wear fabric_wear() { return {0.004, 0.05, 0.02, 0.008, 0.06, 0, 0.16}; }

Recipe plain_recipe(const std::string& name, RandomStream& random, const std::string& material,
                    const Wear& wear, double cell) {
  Recipe r = concrete_recipe(name, random);
  r.material = material;
  r.solid.wear = wear;
  r.cell = cell;
  return r;
}

void break_end(Cell& cell, int axis, int end, double lean, Surface surface, RandomStream& random) {
  const Aabb box = [&] {
    Aabb b;
    for (const Vec3& p : corners_of(cell)) b.include(p);
    return b;
  }();
  const Vec3 middle = (box.min + box.max) * 0.5;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Vec3 tip = middle;
  tip[axis] = end > 0 ? box.max[axis] : box.min[axis];
  Vec3 normal, second;
  normal[axis] = end;
  normal[u] = random.uniform(-lean, lean);
  normal[v] = random.uniform(-lean, lean);
  normal = normalized(normal);
  // Set back so that the lean stays within the old end.
  const double back = 0.5 * (std::fabs(normal[u]) * (box.max[u] - box.min[u]) +
                             std::fabs(normal[v]) * (box.max[v] - box.min[v]));
  cell.push_back({normal, dot(normal, tip) - back, surface});
  second[axis] = end;
  const double way = random.uniform() < 0.5 ? 1 : -1;
  second[u] = way * random.uniform(0.6, 1.0);
  second[v] = random.uniform(-0.5, 0.5);
  second = normalized(second);
  Vec3 corner = tip;
  corner[u] += (second[u] > 0 ? 0.5 : -0.5) * (box.max[u] - box.min[u]);
  const double cut = random.uniform(0.15, 0.35) * (box.max[u] - box.min[u]);
  cell.push_back({second, dot(second, corner) - back - cut * std::fabs(second[u]), surface});
  // The old end would only leave slivers.
  Vec3 old;
  old[axis] = end;
  cell.erase(std::remove_if(cell.begin(), cell.end(),
                            [&](const Face& f) { return dot(f.normal, old) > 0.9999; }),
             cell.end());
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
