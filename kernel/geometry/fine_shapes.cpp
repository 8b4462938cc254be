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

FineShape hull_of(const std::vector<Vec3>& points) {
  const Hull hull = calc_hull(points);
  FineShape shape;
  for (const Vec3& p : hull.points) shape.points.push_back(Vec3f(p));
  for (const std::vector<int>& face : hull.faces)
    for (std::size_t i = 2; i < face.size(); ++i)
      shape.triangles.push_back({std::uint32_t(face[0]), std::uint32_t(face[i - 1]), std::uint32_t(face[i])});
  return shape;
}

FineShape make_polyhedron(FineForm form, RandomStream& random) {
  std::vector<Vec3> corners;
  for (const Vec3& even : even_directions(form)) {
    Vec3 d = normalized(even);
    for (int i = 0; i < 3; ++i) d[i] += kUneven * random.uniform(-1, 1);
    corners.push_back(normalized(d) * random.uniform(kNearest, 1));
  }
  return hull_of(corners);
}

// Corners at any angle and distance, but for three that keep the middle inside. The upper side is a little
// smaller, as broken edges are not upright.
FineShape make_prism(FineForm form, RandomStream& random) {
  const bool shard = form == FineForm::shard;
  const int more = shard ? int(random.below(2)) : 2 + int(random.below(3));
  const double bevel = shard ? 0.97 : 0.86;
  const double turn = random.uniform(0, 2 * portable::kPi);
  std::vector<Vec3> corners;
  for (int i = 0; i < 3 + more; ++i) {
    const double about = i < 3 ? turn + 2 * portable::kPi * (i + random.uniform(-0.2, 0.2)) / 3
                               : random.uniform(0, 2 * portable::kPi);
    const auto [s, c] = portable::sincos(about);
    const double r = i == 0 ? 1 : random.uniform(0.5, 0.95);
    corners.push_back({r * c, r * s, -1}), corners.push_back({bevel * r * c, bevel * r * s, 1});
  }
  return hull_of(corners);
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

FineBase find_base(const FineShape& shape, const Vec3f& half) {
  const auto scaled = [&](std::uint32_t i) {
    const Vec3f& p = shape.points[i];
    return Vec3(double(p.x) * double(half.x), double(p.y) * double(half.y), double(p.z) * double(half.z));
  };
  FineBase base;
  double largest = -1;
  for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
    const auto& t = shape.triangles[i];
    const Vec3 a = scaled(t[0]), twice = cross(scaled(t[1]) - a, scaled(t[2]) - a);
    const double area = norm(twice);
    if (area <= largest) continue;
    largest = area, base = {i, twice * (1 / area), dot(twice, a) / area};
  }
  return base;
}

}  // namespace rubble
