#include "app/assets/convex_parts.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr int kVersion = 3;  // raise it whenever decompose() changes

std::string key_of(const TriangleMesh& mesh, const DecomposeOptions& o) {
  CacheKey key("decompose", kVersion);
  key.add(o.max_parts).add(o.most_parts).add(o.tolerance).add(o.most_outside).add(o.most_gap).add(o.resolution).add(o.max_corners).add(o.thinnest);
  key.add(std::uint64_t(mesh.positions.size())).add(std::uint64_t(mesh.triangles.size()));
  for (const Vec3f& p : mesh.positions) key.add(p.x).add(p.y).add(p.z);
  for (const auto& t : mesh.triangles) key.add(t[0]).add(t[1]).add(t[2]);
  return key.hex();
}

struct Triple {
  double x, y, z;
};

// Without parts: damaged.
Decomposition unpack(const std::string& bytes) {
  CacheReader reader(bytes);
  Decomposition kept;
  std::uint64_t count = 0;
  std::uint8_t exact = 0;
  reader.get(exact), reader.get(kept.volume);
  reader.get(kept.misfit.outside), reader.get(kept.misfit.inside), reader.get(kept.misfit.gap);
  kept.exact = exact != 0;
  reader.get(count);
  std::vector<ConvexPart>& parts = kept.parts;
  for (std::uint64_t i = 0; i < count && i < 1000; ++i) {
    std::vector<Triple> points;
    reader.get(points);
    parts.emplace_back();
    for (const Triple& p : points) parts.back().points.push_back({p.x, p.y, p.z});
  }
  if (!reader.whole()) parts.clear();
  return kept;
}

std::string pack(const Decomposition& made) {
  CacheWriter writer;
  writer.put(std::uint8_t(made.exact)), writer.put(made.volume);
  writer.put(made.misfit.outside), writer.put(made.misfit.inside), writer.put(made.misfit.gap);
  writer.put(std::uint64_t(made.parts.size()));
  for (const ConvexPart& part : made.parts) {
    std::vector<Triple> points;
    for (const Vec3& p : part.points) points.push_back({p.x, p.y, p.z});
    writer.put(points);
  }
  return writer.bytes();
}

}  // namespace

Decomposition decompose_cached(const TriangleMesh& mesh, const DiskCache& cache,
                               const DecomposeOptions& options) {
  const std::string key = key_of(mesh, options);
  if (const std::optional<std::string> kept = cache.find("parts", key)) {
    Decomposition made = unpack(*kept);
    if (!made.parts.empty()) return made;
  }
  Decomposition made = decompose(mesh, options);
  cache.store("parts", key, pack(made));
  return made;
}

namespace {

struct Crossing {
  double z;
  int step;  // +1: the line enters; -1: it leaves
};
using Crossings = std::vector<Crossing>;

// Vertical lines through the middles of a grid's columns, a little off so that they miss corners.
class Lines {
 public:
  Lines(const Aabb& box, int count)
      : count_(count), low_(box.min), step_((box.max - box.min) * (1.0 / count)) {
    at_.resize(std::size_t(count) * std::size_t(count));
  }

  double area() const { return step_.x * step_.y; }
  std::size_t size() const { return at_.size(); }

  // Adds where the lines cross a triangle that is counter-clockwise seen from outside.
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) return;
    const int x0 = column(std::min({a.x, b.x, c.x}), 0), x1 = column(std::max({a.x, b.x, c.x}), 0);
    const int y0 = column(std::min({a.y, b.y, c.y}), 1), y1 = column(std::max({a.y, b.y, c.y}), 1);
    for (int j = y0; j <= y1; ++j) {
      for (int i = x0; i <= x1; ++i) {
        const double x = middle(i, 0), y = middle(j, 1);
        const double u = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area;
        const double v = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / area;
        const double w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        // Facing down: the line enters.
        line(i, j).push_back({u * a.z + v * b.z + w * c.z, area < 0 ? 1 : -1});
      }
    }
  }

  Crossings& line(int i, int j) { return at_[std::size_t(j * count_ + i)]; }
  Crossings& line(std::size_t n) { return at_[n]; }

 private:
  double middle(int i, int axis) const { return low_[axis] + (i + 0.4871) * step_[axis]; }
  int column(double x, int axis) const {
    const double i = step_[axis] > 0 ? (x - low_[axis]) / step_[axis] : 0;
    return std::clamp(int(std::floor(i)), 0, count_ - 1);
  }

  int count_;
  Vec3 low_, step_;
  std::vector<Crossings> at_;
};

// Lengths along one line: in the mesh, in the parts only, in the mesh only.
void add_lengths(Crossings& mesh, Crossings& parts, double lengths[3]) {
  const auto lower = [](const Crossing& a, const Crossing& b) { return a.z < b.z; };
  std::sort(mesh.begin(), mesh.end(), lower);
  std::sort(parts.begin(), parts.end(), lower);
  std::size_t m = 0, p = 0;
  int in_mesh = 0, in_parts = 0;
  double last = 0;
  while (m < mesh.size() || p < parts.size()) {
    const bool take_mesh = p == parts.size() || (m < mesh.size() && mesh[m].z < parts[p].z);
    const Crossing& next = take_mesh ? mesh[m++] : parts[p++];
    const double length = next.z - last;
    if (in_mesh > 0) lengths[0] += length;
    if (in_parts > 0 && in_mesh <= 0) lengths[1] += length;
    if (in_mesh > 0 && in_parts <= 0) lengths[2] += length;
    (take_mesh ? in_mesh : in_parts) += next.step;
    last = next.z;
  }
}

Vec3 corner(const ConvexShape& part, std::size_t i, const Vec3& centre) {
  return Vec3(part.corners[i]) + centre;
}

}  // namespace

HullError calc_hull_error(const TriangleMesh& mesh, const Shape& shape, int lines) {
  const Vec3 centre = shape.volume.centre_of_mass;
  Aabb box = mesh.bounds();
  for (const ConvexShape& part : shape.parts) {
    for (std::size_t i = 0; i < part.corners.size(); ++i) box.include(corner(part, i, centre));
  }
  Lines of_mesh(box, lines), of_parts(box, lines);
  for (const auto& t : mesh.triangles) {
    of_mesh.add_triangle(Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]),
                         Vec3(mesh.positions[t[2]]));
  }
  for (const ConvexShape& part : shape.parts) {
    for (const ConvexShape::Face& face : part.faces) {
      for (std::size_t k = 2; k < face.count; ++k) {
        of_parts.add_triangle(corner(part, part.loops[face.first], centre),
                              corner(part, part.loops[face.first + k - 1], centre),
                              corner(part, part.loops[face.first + k], centre));
      }
    }
  }
  double lengths[3] = {0, 0, 0};
  for (std::size_t n = 0; n < of_mesh.size(); ++n) {
    add_lengths(of_mesh.line(n), of_parts.line(n), lengths);
  }
  const double area = of_mesh.area();
  return {lengths[0] * area, lengths[1] * area, lengths[2] * area};
}

double calc_thickness(const ConvexShape& part) {
  double least = 1e9;
  for (const ConvexShape::Face& face : part.faces) {
    const Vec3 normal(face.normal), on(part.corners[part.loops[face.first]]);
    double depth = 0;
    for (const Vec3f& c : part.corners) depth = std::max(depth, dot(normal, on - Vec3(c)));
    least = std::min(least, depth);
  }
  return least;
}

}  // namespace rubble
