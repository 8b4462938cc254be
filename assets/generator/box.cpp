#include "assets/generator/box.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "assets/generator/noise.h"
#include "assets/generator/surface_mesh.h"

namespace rubble::generator {
namespace {

constexpr double kBevel = 0.02;       // of an edge where it is chipped most; unit: m
constexpr double kBreakDepth = 0.03;  // of the deepest dent of a broken face; unit: m
constexpr double kCastDepth = 0.0015;
constexpr double kMostWear = 0.12;    // wear takes at most this share of the shortest edge

// Lattice coordinates along one axis: the two ends, a bevel inside each, the rest evenly.
std::vector<double> lattice(double size, double bevel, double spacing) {
  const double half = size / 2, inner = half - bevel;
  const int count = std::max(1, static_cast<int>(std::floor(2 * inner / spacing)));
  std::vector<double> c{-half};
  for (int i = 0; i <= count; ++i) c.push_back(-inner + 2 * inner * i / count);
  c.push_back(half);
  return c;
}

Surface broken_surface(Surface surface) {
  if (surface == Surface::brick) return Surface::brick_fracture;
  return surface == Surface::concrete_cast ? Surface::concrete_fracture : surface;
}

class BoxMesher {
 public:
  BoxMesher(const BoxRecipe& recipe, double spacing)
      : recipe_(recipe),
        bevel_(std::min(kBevel, kMostWear * shortest())),
        depth_(std::min(kBreakDepth, kMostWear * shortest())) {
    for (int axis = 0; axis < 3; ++axis)
      grid_[axis] = lattice(recipe.size[axis], bevel_, spacing);
  }

  SurfaceMesh run() {
    for (int face = 0; face < 6; ++face) add_face(face);
    return std::move(mesh_);
  }

 private:
  using Node = std::array<int, 3>;

  double shortest() const {
    return std::min({recipe_.size.x, recipe_.size.y, recipe_.size.z});
  }
  int last(int axis) const { return static_cast<int>(grid_[axis].size()) - 1; }

  // Two triangles for every square of a face, counter-clockwise from outside.
  void add_face(int face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool positive = face % 2 == 0;
    for (int i = 0; i < last(u); ++i) {
      for (int j = 0; j < last(v); ++j) {
        Node n{};
        n[axis] = positive ? last(axis) : 0;
        std::array<int, 4> c;
        for (int k = 0; k < 4; ++k) {
          n[u] = i + (k == 1 || k == 2);
          n[v] = j + (k >= 2);
          c[k] = vertex(n);
        }
        if (!positive) std::swap(c[1], c[3]);
        const bool rim = i == 0 || j == 0 || i + 1 == last(u) || j + 1 == last(v);
        add_triangle({c[0], c[1], c[2]}, face, rim);
        add_triangle({c[0], c[2], c[3]}, face, rim);
      }
    }
  }

  // Beside an edge that was chipped deep, the face shows the break.
  void add_triangle(const std::array<int, 3>& corners, int face, bool rim) {
    bool chipped = recipe_.broken[face];
    if (rim)
      for (const int c : corners) chipped = chipped || worn_[c] > 0.55 * bevel_;
    mesh_.triangles.push_back(corners);
    mesh_.surfaces.push_back(chipped ? broken_surface(recipe_.surface) : recipe_.surface);
  }

  int vertex(const Node& n) {
    const auto [at, is_new] = numbers_.emplace(n, static_cast<int>(mesh_.positions.size()));
    if (!is_new) return at->second;
    Vec3 p{grid_[0][n[0]], grid_[1][n[1]], grid_[2][n[2]]};
    const Vec3 inward = wear(n, p);
    mesh_.positions.push_back(p + inward);
    return at->second;
  }

  // How far the surface receded here, from every face that the node lies on.
  Vec3 wear(const Node& n, const Vec3& p) {
    int faces = 0;
    for (int axis = 0; axis < 3; ++axis) faces += n[axis] == 0 || n[axis] == last(axis);
    const double chip = std::max(0.0, 1.5 * fractal_noise(p * 9.0, 2, recipe_.seed + 1));
    const double edge =
        faces < 2 ? 0 : bevel_ * (0.12 + 0.78 * std::min(1.0, chip * chip));
    worn_.push_back(edge);
    Vec3 inward;
    for (int axis = 0; axis < 3; ++axis) {
      if (n[axis] != 0 && n[axis] != last(axis)) continue;
      const bool positive = n[axis] != 0;
      inward[axis] = (positive ? -1 : 1) * (edge + dent(2 * axis + (positive ? 0 : 1), p));
    }
    return inward;
  }

  double dent(int face, const Vec3& p) const {
    if (!recipe_.broken[face])
      return kCastDepth * (0.5 + 0.5 * gradient_noise(p * 5.0, recipe_.seed + 2));
    const double waves = ridged_noise(p * 6.0, 3, recipe_.seed + 3);
    const double flakes = flake_noise(p * 9.0, recipe_.seed + 4);
    return depth_ * std::min(1.0, std::max(0.0, 0.7 * waves + 0.5 * flakes));
  }

  const BoxRecipe& recipe_;
  double bevel_, depth_;
  std::vector<double> grid_[3];
  std::map<Node, int> numbers_;
  std::vector<double> worn_;  // by vertex: how far its edge receded; unit: m
  SurfaceMesh mesh_;
};

}  // namespace

std::vector<TriangleMesh> make_box(const BoxRecipe& recipe) {
  // Chips need squares of a few centimetres; huge boxes get coarser ones.
  const double longest = std::max({recipe.size.x, recipe.size.y, recipe.size.z});
  const double finest = std::max(0.06, longest / 60);
  std::vector<TriangleMesh> levels;
  for (const double spacing : {finest, 3 * finest, 1e9})
    levels.push_back(finish(BoxMesher(recipe, spacing).run(), kCreaseDeg));
  return levels;
}

Surface surface_of_look(const std::string& look) {
  for (int i = 0; i < kSurfaceCount; ++i)
    if (look == surface_name(Surface(i))) return Surface(i);
  return Surface::concrete_cast;
}

}  // namespace rubble::generator
