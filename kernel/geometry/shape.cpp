#include "kernel/geometry/shape.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/geometry/hull.h"

namespace rubble {
namespace {

// Corners in double precision: a hull's volume must not depend on float rounding.
VolumeProperties volume_of_hull(const Hull& hull) {
  // Sums over tetrahedra from a reference corner (Mirtich 1996 gives the same integrals).
  const Vec3 reference = hull.points[0];
  double volume = 0;
  Vec3 first;       // integral of x
  Mat3 second{};    // integral of x x^T
  for (const auto& face : hull.faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const Vec3 a = hull.points[face[0]] - reference, b = hull.points[face[i]] - reference,
                 c = hull.points[face[i + 1]] - reference;
      const double v = dot(a, cross(b, c)) / 6;
      const Vec3 sum = a + b + c;
      volume += v;
      first += sum * (v / 4);
      for (int r = 0; r < 3; ++r) {
        for (int s = 0; s < 3; ++s) {
          second.rows[r][s] +=
              v / 20 * (a[r] * a[s] + b[r] * b[s] + c[r] * c[s] + sum[r] * sum[s]);
        }
      }
    }
  }
  VolumeProperties result;
  result.volume = volume;
  const Vec3 centre = first * (1 / volume);
  result.centre_of_mass = centre + reference;
  Mat3 central{};
  for (int r = 0; r < 3; ++r) {
    for (int s = 0; s < 3; ++s) central.rows[r][s] = second.rows[r][s] - volume * centre[r] * centre[s];
  }
  const double trace = central.rows[0][0] + central.rows[1][1] + central.rows[2][2];
  for (int r = 0; r < 3; ++r) {
    for (int s = 0; s < 3; ++s) {
      result.inertia.rows[r][s] = (r == s ? trace : 0.0) - central.rows[r][s];
    }
  }
  return result;
}

VolumeProperties sum_of(const std::vector<VolumeProperties>& parts) {
  VolumeProperties total;
  for (const auto& p : parts) {
    total.volume += p.volume;
    total.centre_of_mass += p.centre_of_mass * p.volume;
  }
  total.centre_of_mass *= 1 / total.volume;
  for (const auto& p : parts) {
    const Vec3 d = p.centre_of_mass - total.centre_of_mass;
    const double d2 = dot(d, d);
    for (int r = 0; r < 3; ++r) {
      for (int s = 0; s < 3; ++s) {
        total.inertia.rows[r][s] +=
            p.inertia.rows[r][s] + p.volume * ((r == s ? d2 : 0.0) - d[r] * d[s]);
      }
    }
  }
  return total;
}

ConvexShape compile_part(const Hull& hull, const Vec3& centre) {
  ConvexShape shape;
  for (const Vec3& p : hull.points) {
    shape.corners.push_back(Vec3f(p - centre));
    shape.radius = std::max(shape.radius, norm(shape.corners.back()));
  }
  std::map<std::pair<int, int>, int> face_of_edge;
  for (const auto& loop : hull.faces) {
    Vec3 area;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
      area += cross(hull.points[loop[i]] - hull.points[loop[0]],
                    hull.points[loop[i + 1]] - hull.points[loop[0]]);
    }
    ConvexShape::Face face;
    face.normal = Vec3f(normalized(area));
    face.first = std::uint16_t(shape.loops.size());
    face.count = std::uint16_t(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      shape.loops.push_back(std::uint16_t(loop[i]));
      face_of_edge[{loop[i], loop[(i + 1) % loop.size()]}] = int(shape.faces.size());
    }
    shape.faces.push_back(face);
  }
  for (const auto& [edge, left] : face_of_edge) {
    const auto twin = face_of_edge.find({edge.second, edge.first});
    if (edge.first > edge.second || twin == face_of_edge.end()) continue;
    shape.edges.push_back({std::uint16_t(edge.first), std::uint16_t(edge.second),
                           std::uint16_t(left), std::uint16_t(twin->second)});
  }
  return shape;
}

[[noreturn]] void fail(const std::string& key, const std::string& message,
                       const std::string& expected, const std::string& found) {
  Diagnostic d;
  d.key = key;
  d.message = message;
  d.expected = expected;
  d.found = found;
  throw InputError(d);
}

void check_material(const PieceType& type, const std::string& key) {
  if (!(type.density >= kLeastDensity && type.density <= kMostDensity)) {
    fail(key + ".density", "out of range", "10 to 20000 kg/m3", plain_text(type.density));
  }
  if (!(type.friction >= 0 && type.friction <= 2)) {
    fail(key + ".friction", "out of range", "0 to 2", plain_text(type.friction));
  }
  // What touches nothing has its mass from its volume.
  if (!type.parts.empty() && type.surface)
    fail(key + ".parts", "both parts and a surface", "at least one part, or a surface", "both");
  if (type.parts.empty() && !type.surface && !type.volume)
    fail(key + ".parts", "no collision part", "at least one part, a surface, or a volume that touches nothing", "none");
}

// It never moves: mass and centre do not matter.
Shape compile_surface(const TriangleMesh& mesh, const std::string& key) {
  Shape shape;
  try {
    shape.surface = std::make_shared<const TriangleMeshShape>(mesh);
  } catch (const std::exception& error) {
    fail(key + ".surface", error.what(), "a mesh with triangles that have an area",
         std::to_string(mesh.triangles.size()) + " triangles");
  }
  const Aabb box = shape.surface->bounds();
  shape.reach = Vec3f(max(box.max, -box.min));
  shape.radius = norm(shape.reach);
  return shape;
}

}  // namespace

VolumeProperties calc_volume_properties(const ConvexPart& part) {
  return volume_of_hull(calc_hull(part.points));
}

Shape compile_shape(const PieceType& type, const std::string& key) {
  check_material(type, key);
  if (type.surface) return compile_surface(*type.surface, key);
  std::vector<Hull> hulls;
  std::vector<VolumeProperties> volumes;
  for (std::size_t i = 0; i < type.parts.size(); ++i) {
    try {
      hulls.push_back(calc_hull(type.parts[i].points));
    } catch (const std::exception& error) {
      fail(key + ".parts[" + std::to_string(i) + "]", error.what(),
           "at least 4 points that are not in one plane",
           std::to_string(type.parts[i].points.size()) + " points");
    }
    if (hulls.back().points.size() > kMostPartCorners) {
      fail(key + ".parts[" + std::to_string(i) + "]", "too many corners",
           std::to_string(kMostPartCorners) + " at most, as simplify_hull() gives them",
           std::to_string(hulls.back().points.size()));
    }
    volumes.push_back(volume_of_hull(hulls.back()));
  }
  Shape shape;
  shape.volume = type.volume ? *type.volume : sum_of(volumes);
  if (!(shape.volume.volume > 0)) {
    fail(key + ".volume", "the volume is not positive", "more than 0 m3",
         brief_text(shape.volume.volume));
  }
  for (const Hull& hull : hulls) {
    shape.parts.push_back(compile_part(hull, shape.volume.centre_of_mass));
    shape.radius = std::max(shape.radius, shape.parts.back().radius);
    for (const Vec3f& p : shape.parts.back().corners) {
      shape.reach = max(shape.reach, max(p, -p));
    }
  }
  return shape;
}

}  // namespace rubble
