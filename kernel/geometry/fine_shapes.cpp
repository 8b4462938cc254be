#include "kernel/geometry/fine_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>

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

namespace {

// Grit up to this long is shaded as if round: a face of it is hardly a pixel. Half of it; unit: m.
constexpr float kRoundBelow = 0.003f;

using HeapKey = std::tuple<int, std::int32_t, int, int, int>;  // kind, host, cell

HeapKey key_of(FineKind kind, std::int32_t host, const Vec3f& at) {
  const auto cell = [](float x) { return int(std::floor(double(x) / kFineCell)); };
  return {int(kind), host, cell(at.x), cell(at.y), cell(at.z)};
}

Vec3f calc_normal(const Vec3f& a, const Vec3f& b, const Vec3f& c) { return normalized(cross(b - a, c - a)); }

class HeapMesh {
 public:
  HeapMesh(TriangleMesh& mesh, const std::vector<std::string>& surfaces)
      : mesh_(mesh), surfaces_(surfaces), number_(surfaces.size(), -1) {}

  void add(const FinePiece& piece) {
    const FineShape& shape = fine_shape(piece.shape);
    std::vector<Vec3f> points;
    for (const Vec3f& p : shape.points)
      points.push_back(piece.rotation.rotate({p.x * piece.half.x, p.y * piece.half.y, p.z * piece.half.z}) +
                       piece.position);
    const bool round = piece.kind == FineKind::grit && piece.half.x < kRoundBelow;
    if (round)
      add_round(points, shape, piece);
    else
      add_flat(points, shape.triangles, piece.surface);
  }

  void add(const FineSheet& sheet) {
    const auto base = std::uint32_t(mesh_.positions.size());
    mesh_.positions.insert(mesh_.positions.end(), sheet.mesh.positions.begin(), sheet.mesh.positions.end());
    mesh_.normals.insert(mesh_.normals.end(), sheet.mesh.normals.begin(), sheet.mesh.normals.end());
    for (const auto& t : sheet.mesh.triangles) add_triangle(base + t[0], base + t[1], base + t[2], sheet.surface);
  }

 private:
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint8_t surface) {
    mesh_.triangles.push_back({a, b, c});
    int& number = number_.at(surface);
    if (number < 0) number = int(mesh_.surface_names.size()), mesh_.surface_names.push_back(surfaces_[surface]);
    mesh_.surfaces.push_back(std::uint8_t(number));
  }

  // Normals are means over the faces that are seen: with the one that it lies on, corners would be in the dark
  // below it.
  void add_round(const std::vector<Vec3f>& points, const FineShape& shape, const FinePiece& piece) {
    const auto base = std::uint32_t(mesh_.positions.size());
    const std::size_t hidden = find_base(shape, piece.half).triangle;
    mesh_.positions.insert(mesh_.positions.end(), points.begin(), points.end());
    std::vector<Vec3f> normals(points.size());
    for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
      const auto& t = shape.triangles[i];
      if (i == hidden) continue;
      for (const std::uint32_t corner : t) normals[corner] += calc_normal(points[t[0]], points[t[1]], points[t[2]]);
    }
    for (const Vec3f& n : normals) mesh_.normals.push_back(normalized(n));
    for (const auto& t : shape.triangles) add_triangle(base + t[0], base + t[1], base + t[2], piece.surface);
  }

  void add_flat(const std::vector<Vec3f>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                std::uint8_t surface) {
    for (const auto& t : triangles) {
      const auto base = std::uint32_t(mesh_.positions.size());
      const Vec3f normal = calc_normal(points[t[0]], points[t[1]], points[t[2]]);
      for (const std::uint32_t corner : t)
        mesh_.positions.push_back(points[corner]), mesh_.normals.push_back(normal);
      add_triangle(base, base + 1, base + 2, surface);
    }
  }

  TriangleMesh& mesh_;
  const std::vector<std::string>& surfaces_;  // of all fines
  std::vector<int> number_;                   // of each of them in the mesh; -1: not there
};

Vec3f middle_of(const TriangleMesh& mesh) {
  const Aabb box = mesh.bounds();
  return Vec3f((box.min + box.max) * 0.5);
}

}  // namespace

void heap_fines(Fines& fines) {
  std::map<HeapKey, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> heaps;  // pieces, sheets
  for (std::size_t i = 0; i < fines.pieces.size(); ++i) {
    const FinePiece& piece = fines.pieces[i];
    heaps[key_of(piece.kind, piece.host, piece.position)].first.push_back(i);
  }
  for (std::size_t i = 0; i < fines.sheets.size(); ++i) {
    const FineSheet& sheet = fines.sheets[i];
    heaps[key_of(sheet.kind, sheet.host, middle_of(sheet.mesh))].second.push_back(i);
  }
  std::vector<FineHeap> made;
  made.reserve(heaps.size());
  for (const auto& [key, members] : heaps) {
    made.push_back({FineKind(std::get<0>(key)), std::get<1>(key), {}});
    HeapMesh mesh(made.back().mesh, fines.surfaces);
    for (const std::size_t i : members.first) mesh.add(fines.pieces[i]);
    for (const std::size_t i : members.second) mesh.add(fines.sheets[i]);
  }
  fines.gathered = std::make_shared<const std::vector<FineHeap>>(std::move(made));
}

Pose world_from_host(const PileState& pile, int host) {
  return host < 0 ? Pose{} : pile.pieces[std::size_t(host)].world_from_body;
}

}  // namespace rubble
