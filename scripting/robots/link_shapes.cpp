#include "scripting/robots/link_shapes.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr int kSmallFacets = 20, kTinyFacets = 10;  // of what is a few cm and one cm across
constexpr int kScannerFacets = 28;

Vec3 on_ring(const Ring& ring, int k, int facets) {
  const auto [s, c] = portable::sincos(2 * portable::kPi * k / facets);
  return {ring.x, ring.radius * c, ring.radius * s};
}

// The band between two rings; one of them may be a point.
void add_ring_band(const Ring& a, const Ring& b, int facets, const Pose& at, MeshBuilder& out) {
  for (int k = 0; k < facets; ++k) {
    const int next = (k + 1) % facets;
    const Vec3 a0 = at * on_ring(a, k, facets), a1 = at * on_ring(a, next, facets);
    const Vec3 b0 = at * on_ring(b, k, facets), b1 = at * on_ring(b, next, facets);
    if (a.radius > 0) out.triangle(a0, a1, b.radius > 0 ? b1 : b0);
    if (b.radius > 0) out.triangle(a0, b1, b0);
  }
}

// A fan about the middle of a flat outline that is seen whole from there.
void add_cap(const std::vector<Vec3>& corners, MeshBuilder& out) {
  Vec3 middle;
  for (const Vec3& corner : corners) middle += corner * (1.0 / double(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) out.triangle(middle, corners[i], corners[(i + 1) % corners.size()]);
}

std::vector<Vec3> placed(const Outline& outline, double y, const Pose& at) {
  std::vector<Vec3> corners;
  for (const Vec3& p : outline) corners.push_back(at * Vec3{p.x, y, p.z});
  return corners;
}

// The sides of an extruded outline, from `a` to `b`, which lies further along Y.
void add_walls(const std::vector<Vec3>& a, const std::vector<Vec3>& b, MeshBuilder& out) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t next = (i + 1) % a.size();
    out.quad(a[next], a[i], b[i], b[next]);
  }
}

Vec3 edge_normal(const Vec3& a, const Vec3& b) { return normalized(Vec3{b.z - a.z, 0, a.x - b.x}); }

// The outline, its edges moved inwards.
Outline inset(const Outline& outline, double by) {
  Outline moved;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 &before = outline[(i + outline.size() - 1) % outline.size()], &here = outline[i],
               &after = outline[(i + 1) % outline.size()];
    const Vec3 n1 = edge_normal(before, here), n2 = edge_normal(here, after);
    moved.push_back(here - (n1 + n2) * (by / (1 + dot(n1, n2))));
  }
  return moved;
}

std::vector<Vec3> round_corners(const std::vector<Vec3>& line, double bend) {
  constexpr int kSteps = 4;
  std::vector<Vec3> rounded{line.front()};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vec3 a = line[i] + normalized(line[i - 1] - line[i]) * bend;
    const Vec3 b = line[i] + normalized(line[i + 1] - line[i]) * bend;
    for (int k = 0; k <= kSteps; ++k) {
      const double t = double(k) / kSteps;
      rounded.push_back(a * ((1 - t) * (1 - t)) + line[i] * (2 * t * (1 - t)) + b * (t * t));
    }
  }
  rounded.push_back(line.back());
  return rounded;
}

}  // namespace

Pose facing(const Vec3& centre, const Vec3& axis) {
  if (axis.x < -0.999999) return {{0, 0, 0, 1}, centre};
  return {normalized(Quat{1 + axis.x, 0, -axis.z, axis.y}), centre};
}

void add_lathe(const std::vector<Ring>& rings, int facets, const Pose& at, MeshBuilder& out) {
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) add_ring_band(rings[i], rings[i + 1], facets, at, out);
  if (rings.front().radius > 0) add_ring_band({rings.front().x, 0}, rings.front(), facets, at, out);
  if (rings.back().radius > 0) add_ring_band(rings.back(), {rings.back().x, 0}, facets, at, out);
}

void add_collar(const std::vector<Ring>& outline, int facets, const Pose& at, MeshBuilder& out) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    add_ring_band(outline[i], outline[(i + 1) % outline.size()], facets, at, out);
}

void add_bolt(double radius, const Pose& at, MeshBuilder& out) {
  add_lathe({{-0.5 * radius, radius}, {0.7 * radius, 0.92 * radius}}, 6, at, out);
}

void add_bolt_circle(double circle, int count, double radius, const Pose& at, MeshBuilder& out) {
  for (int k = 0; k < count; ++k) add_bolt(radius, at * Pose{{}, on_ring({0, circle}, k, count)}, out);
}

void add_chamfered_box(const Vec3& size, const Vec3& centre, double chamfer, const Pose& at, MeshBuilder& out) {
  const Vec3 half = size * 0.5, flat = half - Vec3{chamfer, chamfer, chamfer};
  // The corner with these signs (x: bit 0, y: bit 1, z: bit 2), on the face across an axis.
  const auto corner = [&](int signs, int axis) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = ((signs >> i & 1) != 0 ? 1 : -1) * (i == axis ? half[i] : flat[i]);
    return at * (centre + p);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, w = 1 << axis;
    const int third = (axis + 1) % 3;
    out.quad(corner(w, axis), corner(w | u, axis), corner(w | u | v, axis), corner(w | v, axis));
    out.quad(corner(0, axis), corner(v, axis), corner(u | v, axis), corner(u, axis));
    // The chamfers along the axis after the next, between this face and the next.
    for (int k = 0; k < 4; ++k) {
      const int signs = ((k & 1) != 0 ? w : 0) | ((k & 2) != 0 ? u : 0);
      const Vec3 a = corner(signs, axis), b = corner(signs, third), c = corner(signs | v, third),
                 d = corner(signs | v, axis);
      if (k == 0 || k == 3)
        out.quad(a, b, c, d);
      else
        out.quad(d, c, b, a);
    }
  }
  for (int signs = 0; signs < 8; ++signs) {
    const bool odd = ((signs ^ signs >> 1 ^ signs >> 2) & 1) != 0;
    if (odd)
      out.triangle(corner(signs, 0), corner(signs, 1), corner(signs, 2));
    else
      out.triangle(corner(signs, 0), corner(signs, 2), corner(signs, 1));
  }
}

void add_block(const std::array<Vec3, 8>& corners, const Pose& at, MeshBuilder& out) {
  std::array<Vec3, 8> p;
  for (std::size_t i = 0; i < 8; ++i) p[i] = at * corners[i];
  out.quad(p[3], p[2], p[1], p[0]);
  out.quad(p[4], p[5], p[6], p[7]);
  for (std::size_t i = 0; i < 4; ++i) out.quad(p[i], p[(i + 1) % 4], p[(i + 1) % 4 + 4], p[i + 4]);
}

Outline make_belt_outline(double radius_a, double radius_b, double length, int arc) {
  // Where the straight parts touch the circles, from the X axis.
  const double touch = portable::acos((radius_a - radius_b) / length);
  const auto add_arc = [](double x, double radius, double from, double to, int steps, Outline& outline) {
    for (int k = 0; k <= steps; ++k) {
      const auto [s, c] = portable::sincos(from + (to - from) * k / steps);
      outline.push_back({x + radius * c, 0, radius * s});
    }
  };
  Outline outline;
  add_arc(length, radius_b, -touch, touch, arc, outline);
  add_arc(0, radius_a, touch, 2 * portable::kPi - touch, arc, outline);
  return outline;
}

void add_slab(const Outline& outline, double from, double to, double chamfer, const Pose& at, MeshBuilder& out) {
  const Outline small = inset(outline, chamfer);
  std::vector<Vec3> ends[] = {placed(small, from, at), placed(outline, from + chamfer, at),
                              placed(outline, to - chamfer, at), placed(small, to, at)};
  for (int i = 0; i < 3; ++i) add_walls(ends[i], ends[i + 1], out);
  add_cap(ends[0], out);
  std::reverse(ends[3].begin(), ends[3].end());
  add_cap(ends[3], out);
}

void add_band(const Outline& outer, const Outline& inner, double from, double to, const Pose& at, MeshBuilder& out) {
  const std::vector<Vec3> a = placed(outer, from, at), b = placed(outer, to, at), c = placed(inner, to, at),
                          d = placed(inner, from, at);
  add_walls(a, b, out);
  add_walls(b, c, out);
  add_walls(c, d, out);
  add_walls(d, a, out);
}

OutlineSpot find_outline_spot(const Outline& outline, double share) {
  const auto corner = [&](std::size_t i) { return outline[i % outline.size()]; };
  double length = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) length += distance(corner(i), corner(i + 1));
  double left = share * length;
  std::size_t i = 0;
  for (; i + 1 < outline.size() && left > distance(corner(i), corner(i + 1)); ++i)
    left -= distance(corner(i), corner(i + 1));
  return {corner(i) + normalized(corner(i + 1) - corner(i)) * left, edge_normal(corner(i), corner(i + 1))};
}

void add_pipe(const std::vector<Vec3>& line, double radius, double bend, int sides, const Pose& at, MeshBuilder& out) {
  const std::vector<Vec3> points = line.size() > 2 ? round_corners(line, bend) : line;
  const Vec3 start = normalized(points[1] - points[0]);
  Vec3 across = normalized(cross(start, std::fabs(start.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  std::vector<Vec3> before;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 along = normalized(points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0]);
    across = normalized(across - along * dot(across, along));
    const Vec3 up = cross(along, across);
    std::vector<Vec3> ring;
    for (int k = 0; k < sides; ++k) {
      const auto [s, c] = portable::sincos(2 * portable::kPi * k / sides);
      ring.push_back(at * (points[i] + (across * c + up * s) * radius));
    }
    for (std::size_t k = 0; k < before.size(); ++k) {
      const std::size_t next = (k + 1) % ring.size();
      out.quad(before[k], before[next], ring[next], ring[k]);
    }
    before = ring;
    if (i + 1 == points.size()) add_cap(ring, out);
    std::reverse(ring.begin(), ring.end());
    if (i == 0) add_cap(ring, out);
  }
}

void add_lamp(double radius, const Pose& at, MeshBuilder& out) {
  const double r = radius;
  out.look("polymer_black");
  add_collar({{0, 0.86 * r}, {0, r}, {0.5 * r, r}, {0.6 * r, 0.95 * r}, {0.6 * r, 0.86 * r}}, kSmallFacets, at, out);
  out.look("aluminium");
  add_lathe({{0, 0.9 * r}, {0.5 * r, 0.9 * r}, {0.12 * r, 0.3 * r}}, kSmallFacets, at, out);
  out.look("paint_light");
  add_lathe({{0.1 * r, 0.2 * r}, {0.2 * r, 0.2 * r}, {0.28 * r, 0.1 * r}}, kTinyFacets, at, out);
}

void add_lens(double radius, const Pose& at, MeshBuilder& out) {
  const double r = radius;
  out.look("polymer_black");
  add_collar(
      {{-0.1 * r, 0.6 * r}, {-0.1 * r, r}, {0.5 * r, r}, {0.6 * r, 0.92 * r}, {0.6 * r, 0.78 * r}, {0.35 * r, 0.6 * r}},
      kSmallFacets, at, out);
  out.look("pane");
  add_lathe({{0, 0.65 * r}, {0.3 * r, 0.65 * r}, {0.42 * r, 0.5 * r}, {0.5 * r, 0.25 * r}, {0.52 * r, 0}}, kSmallFacets,
            at, out);
}

void add_scanner(double radius, double height, const Pose& at, MeshBuilder& out) {
  const double r = radius, h = height;
  const Pose up = at * facing({}, {0, 0, 1});
  out.look("aluminium");
  add_lathe({{0, 0.96 * r}, {0.05 * h, r}, {0.22 * h, r}, {0.26 * h, 0.95 * r}}, kScannerFacets, up, out);
  out.look("pane");
  add_lathe({{0.24 * h, 0.93 * r}, {0.76 * h, 0.93 * r}}, kScannerFacets, up, out);
  out.look("aluminium");
  add_lathe({{0.74 * h, 0.95 * r}, {0.78 * h, r}, {0.92 * h, r}, {h, 0.86 * r}}, kScannerFacets, up, out);
}

void add_aerial(double height, const Pose& at, MeshBuilder& out) {
  const Pose up = at * facing({}, {0, 0, 1});
  out.look("aluminium");
  add_lathe({{-0.002, 0.008}, {0.008, 0.008}, {0.010, 0.006}}, kTinyFacets, up, out);
  out.look("polymer_black");
  add_lathe(
      {{0.009, 0.0055}, {0.3 * height, 0.005}, {0.34 * height, 0.0035}, {height - 0.002, 0.003}, {height, 0.0015}},
      kTinyFacets, up, out);
}

void add_stop_button(const Pose& at, MeshBuilder& out) {
  out.look("paint_light");
  add_chamfered_box({0.04, 0.04, 0.016}, {0, 0, 0.007}, 0.003, at, out);
  const Pose up = at * facing({}, {0, 0, 1});
  out.look("polymer_black");
  add_lathe({{0.014, 0.010}, {0.020, 0.010}}, kTinyFacets, up, out);
  out.look("paint_red");
  add_lathe({{0.019, 0.011}, {0.021, 0.0145}, {0.026, 0.0145}, {0.029, 0.011}, {0.030, 0}}, kSmallFacets, up, out);
}

}  // namespace rubble
