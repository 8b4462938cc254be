#include "kernel/queries/query_triangle.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

// Of a triple product of vectors of length 1, rounded up generously.
constexpr double kRounding = 2e-15;

}  // namespace

std::optional<double> find_hit(const QueryTriangle& triangle, const Vec3& origin,
                               const Vec3& direction) {
  const Vec3 a = triangle.a - origin, b = triangle.b - origin, c = triangle.c - origin;
  const double u = dot(direction, cross(b, c));
  const double v = dot(direction, cross(c, a));
  const double w = dot(direction, cross(a, b));
  const double size = std::max(dot(a, a), std::max(dot(b, b), dot(c, c)));
  const double rounding = kRounding * size * norm(direction);
  const bool inside = (u >= -rounding && v >= -rounding && w >= -rounding) ||
                      (u <= rounding && v <= rounding && w <= rounding);
  const double sum = u + v + w;
  if (!inside || std::abs(sum) <= 4 * rounding) return std::nullopt;
  const Vec3 point = a * (u / sum) + b * (v / sum) + c * (w / sum);
  const double t = dot(point, direction) / dot(direction, direction);
  if (!(t >= 0)) return std::nullopt;
  return t;
}

Vec3 find_closest(const QueryTriangle& triangle, const Vec3& point) {
  const Vec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 ap = point - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = point - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = point - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const double scale = 1 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

double calc_winding(const QueryTriangle& triangle, const Vec3& point) {
  const Vec3 a = triangle.a - point, b = triangle.b - point, c = triangle.c - point;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return portable::atan2(dot(a, cross(b, c)), below) / (2 * portable::kPi);
}

}  // namespace rubble
