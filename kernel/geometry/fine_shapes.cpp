#include "kernel/geometry/fine_shapes.h"

#include <algorithm>
#include <string>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/hull.h"

namespace rubble {
namespace {

constexpr double kUneven = 0.28;  // of the directions of corners, about even ones
constexpr double kNearest = 0.72;  // of corners from the middle; the farthest: 1

std::vector<Vec3> even_directions(FineForm form) {
  if (form == FineForm::chip) return {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  if (form == FineForm::pebble) return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  constexpr double g = 1.618033988749895;  // of an icosahedron
  std::vector<Vec3> all;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) all.push_back({0, a, b}), all.push_back({a, b, 0}), all.push_back({b, 0, a});
  return all;
}

FineShape make_polyhedron(FineForm form, RandomStream& random) {
  std::vector<Vec3> corners;
  for (const Vec3& even : even_directions(form)) {
    Vec3 d = normalized(even);
    for (int i = 0; i < 3; ++i) d[i] += kUneven * random.uniform(-1, 1);
    corners.push_back(normalized(d) * random.uniform(kNearest, 1));
  }
  const Hull hull = calc_hull(corners);
  FineShape shape;
  for (const Vec3& p : hull.points) shape.points.push_back(Vec3f(p));
  for (const std::vector<int>& face : hull.faces)
    for (std::size_t i = 2; i < face.size(); ++i)
      shape.triangles.push_back({std::uint32_t(face[0]), std::uint32_t(face[i - 1]), std::uint32_t(face[i])});
  return shape;
}

// Corners on an ellipse, at uneven angles: convex. The upper side is a little smaller, as broken edges are
// not upright.
FineShape make_prism(FineForm form, RandomStream& random) {
  const bool shard = form == FineForm::shard;
  const auto n = std::uint32_t(shard ? 3 + random.below(2) : 5 + random.below(3));
  const double bevel = shard ? 0.97 : 0.86, turn = random.uniform(0, 2 * portable::kPi);
  FineShape shape;
  for (const double z : {-1.0, 1.0})
    for (std::uint32_t i = 0; i < n; ++i) shape.points.push_back({0, 0, float(z)});
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = turn + 2 * portable::kPi * (i + random.uniform(-0.3, 0.3)) / n;
    const auto [s, c] = portable::sincos(angle);
    for (const std::uint32_t k : {i, n + i}) {
      const double r = k < n ? 1 : bevel;
      shape.points[k].x = float(r * c), shape.points[k].y = float(r * s);
    }
  }
  for (std::uint32_t i = 2; i < n; ++i) {
    shape.triangles.push_back({0, i, i - 1});
    shape.triangles.push_back({n, n + i - 1, n + i});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    shape.triangles.push_back({i, j, n + j});
    shape.triangles.push_back({i, n + j, n + i});
  }
  return shape;
}

std::vector<FineShape> make_shapes() {
  std::vector<FineShape> shapes;
  for (int i = 0; i < kFineShapes; ++i) {
    const auto form = FineForm(i / kShapesOfForm);
    RandomStream random(1, "fine shape " + std::to_string(i));
    shapes.push_back(form >= FineForm::flake ? make_prism(form, random) : make_polyhedron(form, random));
  }
  return shapes;
}

}  // namespace

const FineShape& fine_shape(int number) {
  static const std::vector<FineShape> shapes = make_shapes();
  return shapes.at(std::size_t(number));
}

}  // namespace rubble
