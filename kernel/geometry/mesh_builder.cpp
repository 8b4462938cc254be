#include "kernel/geometry/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernel/base/portable_math.h"

namespace rubble {

void MeshBuilder::look(const std::string& name) {
  auto& names = mesh_.surface_names;
  const auto at = std::find(names.begin(), names.end(), name);
  look_ = std::uint8_t(at - names.begin());
  if (at == names.end()) names.push_back(name);
}

void MeshBuilder::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::uint32_t first = std::uint32_t(mesh_.positions.size());
  for (const Vec3& p : {a, b, c}) mesh_.positions.push_back(Vec3f(frame_ * p));
  mesh_.triangles.push_back({first, first + 1, first + 2});
  mesh_.surfaces.push_back(look_);
}

void MeshBuilder::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  triangle(a, b, c), triangle(a, c, d);
}

void MeshBuilder::leaf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  quad(a, b, c, d);
  triangle(a, c, b), triangle(a, d, c);
}

void MeshBuilder::face(const std::vector<Vec3>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) triangle(corners[0], corners[i - 1], corners[i]);
}

void MeshBuilder::box(const Vec3& l, const Vec3& h) {
  const auto p = [&](int x, int y, int z) { return Vec3(x ? h.x : l.x, y ? h.y : l.y, z ? h.z : l.z); };
  quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  quad(p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1));
  quad(p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1));
  quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  quad(p(0, 1, 0), p(1, 1, 0), p(1, 0, 0), p(0, 0, 0));
}

void MeshBuilder::tube(const Vec3& a, const Vec3& b, double radius_a, double radius_b, int sides) {
  const Vec3 along = normalized(b - a);
  const Vec3 side = std::fabs(along.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 x = normalized(cross(side, along)), y = cross(along, x);
  std::vector<Vec3> low, high;
  for (int i = 0; i < sides; ++i) {
    const portable::SinCos t = portable::sincos(2 * portable::kPi * i / sides);
    const Vec3 out = x * t.cos + y * t.sin;
    low.push_back(a + out * radius_a), high.push_back(b + out * radius_b);
  }
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t k = (i + 1) % low.size();
    quad(low[i], low[k], high[k], high[i]);
  }
  face(high);
  std::reverse(low.begin(), low.end());
  face(low);
}

TriangleMesh MeshBuilder::take() {
  TriangleMesh out = std::move(mesh_);
  mesh_ = {}, look_ = 0;
  return out;
}

TriangleMesh MeshBuilder::take_smooth(double crease_deg) {
  TriangleMesh out = take();
  const double least = portable::cos(crease_deg * portable::kPi / 180);
  struct Corner {
    std::tuple<float, float, float, std::uint8_t> place;  // its position and look
    std::uint32_t triangle, vertex;
  };
  std::vector<Corner> corners;
  std::vector<Vec3> faces, units;  // as long as twice the area; of unit length
  for (std::uint32_t t = 0; t < out.triangles.size(); ++t) {
    const auto& v = out.triangles[t];
    const Vec3 a(out.positions[v[0]]), b(out.positions[v[1]]), c(out.positions[v[2]]);
    faces.push_back(cross(b - a, c - a)), units.push_back(normalized(faces.back()));
    for (const std::uint32_t i : v) {
      const Vec3f& p = out.positions[i];
      corners.push_back({{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, out.surfaces[t]}, t, i});
    }
  }
  std::stable_sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.place < b.place; });
  out.normals.resize(out.positions.size());
  for (auto first = corners.begin(); first != corners.end();) {
    const auto last = std::find_if(first, corners.end(), [&](const Corner& c) { return c.place != first->place; });
    for (auto own = first; own != last; ++own) {
      Vec3 sum;
      for (auto other = first; other != last; ++other)
        if (dot(units[other->triangle], units[own->triangle]) >= least) sum = sum + faces[other->triangle];
      out.normals[own->vertex] = Vec3f(dot(sum, sum) > 0 ? normalized(sum) : units[own->triangle]);
    }
    first = last;
  }
  return out;
}

}  // namespace rubble
