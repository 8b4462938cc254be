#include <cmath>
#include <map>
#include <tuple>

#include "assets/generator/surface_mesh.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

double round_to(double x, double step) { return std::floor(x / step + 0.5) * step; }

Vec3 rounded(const Vec3& p, double step) {
  return {round_to(p.x, step), round_to(p.y, step), round_to(p.z, step)};
}

// Writes each triangle's corners, sharing those with equal position and normal.
class Finisher {
 public:
  Finisher(const SurfaceMesh& mesh, double crease_deg)
      : mesh_(mesh), min_cos_(portable::cos(crease_deg * portable::kPi / 180)) {
    around_.resize(mesh.positions.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& c = mesh.triangles[t];
      areas_.push_back(cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0])));
      for (const int v : c) around_[v].push_back(static_cast<int>(t));
    }
  }

  TriangleMesh run() {
    for (int s = 0; s < kSurfaceCount; ++s) {
      bool named = false;
      for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        if (mesh_.surfaces[t] != static_cast<Surface>(s)) continue;
        if (!named) result_.surface_names.push_back(surface_name(mesh_.surfaces[t]));
        named = true;
        add_triangle(static_cast<int>(t));
      }
    }
    return std::move(result_);
  }

 private:
  const Vec3& at(int v) const { return mesh_.positions[v]; }

  void add_triangle(int t) {
    std::array<std::uint32_t, 3> corners;
    for (int i = 0; i < 3; ++i) corners[i] = corner(t, mesh_.triangles[t][i]);
    result_.triangles.push_back(corners);
    result_.surfaces.push_back(static_cast<std::uint8_t>(result_.surface_names.size() - 1));
  }

  Vec3 calc_normal(int t, int v) const {
    const Vec3 own = normalized(areas_[t]);
    Vec3 sum;
    for (const int other : around_[v]) {
      const Vec3 n = normalized(areas_[other]);
      if (mesh_.surfaces[other] == mesh_.surfaces[t] && dot(n, own) >= min_cos_) {
        sum += areas_[other];
      }
    }
    return normalized(sum);
  }

  std::uint32_t corner(int t, int v) {
    const Vec3 n = rounded(calc_normal(t, v), 1e-3);
    const auto key = std::make_tuple(v, n.x, n.y, n.z);
    const auto found = numbers_.find(key);
    if (found != numbers_.end()) return found->second;
    const auto number = static_cast<std::uint32_t>(result_.positions.size());
    numbers_.emplace(key, number);
    result_.positions.push_back(Vec3f(rounded_for_file(at(v))));
    result_.normals.push_back(Vec3f(normalized(n)));
    return number;
  }

  const SurfaceMesh& mesh_;
  double min_cos_;
  std::vector<std::vector<int>> around_;
  std::vector<Vec3> areas_;  // normal times twice the area
  std::map<std::tuple<int, double, double, double>, std::uint32_t> numbers_;
  TriangleMesh result_;
};

}  // namespace

Vec3 rounded_for_file(const Vec3& p) { return rounded(p, 1e-5); }

TriangleMesh finish(const SurfaceMesh& mesh, double crease_deg) {
  return Finisher(mesh, crease_deg).run();
}

}  // namespace rubble::generator
