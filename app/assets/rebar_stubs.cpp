#include "app/assets/rebar_stubs.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/hull.h"

namespace rubble {
namespace {

constexpr double kBroken = 0.99999;   // faces whose normal is nearer to an axis are sides of the member; unit: 1
constexpr double kSpacing = 0.35;     // of bars along the edges of a face; unit: m
constexpr double kInside = 0.03;      // where a bar begins, behind the face; unit: m
constexpr double kShortest = 0.06, kLongest = 0.4;  // of what sticks out; unit: m
constexpr double kMostBend = 0.5;     // towards the face's middle, of the way there; unit: 1
constexpr double kThinnest = 0.008, kThickest = 0.032;  // diameters of bars; unit: m
constexpr int kSegments = 2;          // of a bent bar; unit: 1

// A broken face, seen along the axis that its bars run along.
struct Face {
  std::vector<Vec3> corners;
  Vec3 normal, middle;
  int axis = 0;
  double area = 0;  // across the axis; unit: m2
};

// The point of a face's plane above (u, v), the coordinates across its axis.
Vec3 on_plane(const Face& face, double u, double v) {
  Vec3 p;
  const int s = (face.axis + 1) % 3, t = (face.axis + 2) % 3;
  p[s] = u, p[t] = v;
  const double along = dot(face.normal, face.middle) - face.normal[s] * u - face.normal[t] * v;
  p[face.axis] = along / face.normal[face.axis];
  return p;
}

bool is_inside(const Face& face, const Vec3& p, double margin) {
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vec3& a = face.corners[i];
    const Vec3 edge = face.corners[(i + 1) % face.corners.size()] - a;
    const Vec3 inwards = normalized(cross(face.normal, edge));
    if (dot(inwards, p - a) < margin) return false;
  }
  return true;
}

// Along both longer edges of the face's box, at the depth of the cover.
std::vector<Vec3> place_bars(const Face& face, double cover) {
  const int s = (face.axis + 1) % 3, t = (face.axis + 2) % 3;
  double low[2] = {1e30, 1e30}, high[2] = {-1e30, -1e30};
  for (const Vec3& p : face.corners) {
    low[0] = std::min(low[0], p[s]), high[0] = std::max(high[0], p[s]);
    low[1] = std::min(low[1], p[t]), high[1] = std::max(high[1], p[t]);
  }
  const double inset = cover;
  const bool wide = high[0] - low[0] >= high[1] - low[1];
  const int along = wide ? 0 : 1, across = 1 - along;
  const double length = high[along] - low[along] - 2 * inset, depth = high[across] - low[across] - 2 * inset;
  std::vector<Vec3> places;
  if (length < 0 || depth < 0) return places;
  const int count = std::max(2, int(length / kSpacing) + 1);
  for (const double side : {0.0, 1.0}) {
    for (int i = 0; i < count; ++i) {
      double uv[2];
      uv[along] = low[along] + inset + length * i / (count - 1);
      uv[across] = low[across] + inset + depth * side;
      const Vec3 p = on_plane(face, uv[0], uv[1]);
      if (is_inside(face, p, 0.5 * cover)) places.push_back(p);
    }
  }
  return places;
}

// A prism of three sides around a bent line, closed at both ends.
void add_bar(const std::vector<Vec3>& line, double radius, int axis, std::uint8_t surface, TriangleMesh& mesh) {
  const auto first = std::uint32_t(mesh.positions.size());
  const int s = (axis + 1) % 3, t = (axis + 2) % 3;
  for (const Vec3& p : line) {
    for (int k = 0; k < 3; ++k) {
      const portable::SinCos turn = portable::sincos(2 * portable::kPi * k / 3);
      Vec3 corner = p;
      corner[s] += radius * turn.cos, corner[t] += radius * turn.sin;
      mesh.positions.push_back(Vec3f(corner));
    }
  }
  // Corners go round the axis: which way is out depends on where the bar points.
  const bool forwards = line.back()[axis] > line.front()[axis];
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (!forwards) std::swap(b, c);
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.surfaces.push_back(surface);
  };
  const auto rings = std::uint32_t(line.size());
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = 3 * ring + k, b = 3 * ring + (k + 1) % 3;
      add(a, b, b + 3);
      add(a, b + 3, a + 3);
    }
  }
  const std::uint32_t end = 3 * (rings - 1);
  add(end, end + 1, end + 2);
  add(0, 2, 1);
}

std::vector<Face> find_broken(const PieceType& type) {
  std::vector<Face> faces;
  const Hull hull = calc_hull(type.parts[0].points);
  for (const auto& corners : hull.faces) {
    Face face;
    Vec3 area;
    for (const int corner : corners) {
      face.corners.push_back(hull.points[corner]);
      face.middle += hull.points[corner] * (1 / double(corners.size()));
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      area += cross(face.corners[i] - face.corners[0], face.corners[i + 1] - face.corners[0]) * 0.5;
    }
    face.normal = normalized(area);
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(face.normal[axis]) > std::abs(face.normal[face.axis])) face.axis = axis;
    }
    face.area = std::abs(area[face.axis]);
    if (std::abs(face.normal[face.axis]) < kBroken) faces.push_back(face);
  }
  return faces;
}

}  // namespace

void add_rebar_stubs(const PieceType& type, const Reinforcement& bars, const std::string& seed_name,
                     std::uint8_t surface, TriangleMesh& mesh) {
  if (!(bars.ratio > 0)) return;
  RandomStream random(0, "rebar " + seed_name);
  for (const Face& face : find_broken(type)) {
    const std::vector<Vec3> places = place_bars(face, bars.cover);
    if (places.empty()) continue;
    const double area = bars.ratio * face.area / double(places.size());
    const double radius = 0.5 * std::clamp(std::sqrt(4 * area / portable::kPi), kThinnest, kThickest);
    const double out = face.normal[face.axis] > 0 ? 1 : -1;
    for (const Vec3& place : places) {
      const double length = random.uniform(kShortest, kLongest), bend = random.uniform(0, kMostBend);
      Vec3 aside = face.middle - place;
      aside[face.axis] = 0;
      std::vector<Vec3> line{place};
      line[0][face.axis] -= out * kInside;
      for (int i = 1; i <= kSegments; ++i) {
        const double share = double(i) / kSegments;
        Vec3 p = place + aside * (bend * share * share);
        p[face.axis] = place[face.axis] + out * length * share;
        line.push_back(p);
      }
      add_bar(line, radius, face.axis, surface, mesh);
    }
  }
}

}  // namespace rubble
