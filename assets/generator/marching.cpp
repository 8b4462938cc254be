#include <algorithm>
#include <cmath>

#include "assets/generator/surface_mesh.h"
#include "kernel/base/error.h"

namespace rubble::generator {
namespace {

constexpr int kBlock = 6;  // nodes a side
constexpr double kLater = 1e8;  // stands for a value of this sign that nobody has asked for yet

class Marcher {
 public:
  Marcher(const Solid& solid, double cell) : solid_(solid), cell_(cell), band_(2 * cell) {
    const Aabb box = bounds(solid);
    origin_ = box.min - Vec3(1.37, 1.41, 1.33) * cell;  // off the faces of boxes
    const Vec3 extent = box.max - origin_;
    for (int i = 0; i < 3; ++i) size_[i] = static_cast<int>(extent[i] / cell) + 3;
    sample_grid();
  }

  SurfaceMesh run() {
    for (int z = 0; z + 1 < size_[2]; ++z) {
      for (int y = 0; y + 1 < size_[1]; ++y) {
        for (int x = 0; x + 1 < size_[0]; ++x) march_cube(x, y, z);
      }
    }
    label();
    return std::move(mesh_);
  }

 private:
  int node(int x, int y, int z) const { return (z * size_[1] + y) * size_[0] + x; }

  Vec3 position(int n) const {
    const int x = n % size_[0], y = n / size_[0] % size_[1], z = n / (size_[0] * size_[1]);
    return origin_ + Vec3(x, y, z) * cell_;
  }

  // Block by block: most are wholly outside or deep inside, which one sample tells.
  void sample_grid() {
    const int count = size_[0] * size_[1] * size_[2];
    values_.resize(count);
    vertices_.assign(7 * static_cast<std::size_t>(count), -1);
    for (int i = 0; i < 3; ++i) blocks_[i] = (size_[i] + kBlock - 1) / kBlock;
    views_.resize(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]));
    for (int z = 0; z < size_[2]; z += kBlock) {
      for (int y = 0; y < size_[1]; y += kBlock) {
        for (int x = 0; x < size_[0]; x += kBlock) sample_block(x, y, z);
      }
    }
  }

  SolidView& view_at(int x, int y, int z) {
    const int block = (z / kBlock * blocks_[1] + y / kBlock) * blocks_[0] + x / kBlock;
    return views_[static_cast<std::size_t>(block)];
  }
  // Of the block that a node is in; it reaches to the ends of the edges that start there.
  const SolidView& view_at(int n) {
    return view_at(n % size_[0], n / size_[0] % size_[1], n / (size_[0] * size_[1]));
  }

  void sample_block(int x0, int y0, int z0) {
    constexpr double kHalf = 0.5 * (kBlock - 1);
    const Vec3 middle = origin_ + Vec3(x0 + kHalf, y0 + kHalf, z0 + kHalf) * cell_;
    const double radius = 1.7321 * (kHalf + 1) * cell_;
    SolidView& view = view_at(x0, y0, z0);
    view = view_near(solid_, middle, radius, band_);
    const double plain = plain_value(view, middle);
    const bool far =
        plain > radius + band_ || plain < -radius - band_ - view.deepest;
    for (int z = z0; z < std::min(z0 + kBlock, size_[2]); ++z) {
      for (int y = y0; y < std::min(y0 + kBlock, size_[1]); ++y) {
        for (int x = x0; x < std::min(x0 + kBlock, size_[0]); ++x) {
          const int n = node(x, y, z);
          if (far) {
            values_[n] = plain;
          } else {
            sample_node(view, n);
          }
        }
      }
    }
  }

  // Noise is what costs: where the side is plain to see, the value waits until an edge asks for it.
  void sample_node(const SolidView& view, int n) {
    const Vec3 p = position(n);
    const FieldSide side = side_of(view, p);
    values_[n] = side == FieldSide::inside    ? -kLater
                 : side == FieldSide::outside ? kLater
                                              : sample(view, p, band_).value;
  }
  double value_at(int n) {
    double& value = values_[n];
    if (value == kLater || value == -kLater) value = sample(view_at(n), position(n), band_).value;
    return value;
  }

  // The vertex on the grid edge between nodes a and b, which differ by `step` (bits x, y, z).
  int vertex_on(int a, int b) {
    const int low = a < b ? a : b, high = a < b ? b : a;
    const int difference = high - low, layer = size_[0] * size_[1];
    const int dz = difference / layer, dy = difference % layer / size_[0];
    const int step = difference % size_[0] + 2 * dy + 4 * dz;
    int& vertex = vertices_[7 * static_cast<std::size_t>(low) + step - 1];
    if (vertex < 0) {
      vertex = static_cast<int>(mesh_.positions.size());
      mesh_.positions.push_back(crossing(low, high));
    }
    return vertex;
  }

  // Two steps of false position: edges bend the field within one cell of the grid.
  Vec3 crossing(int low, int high) {
    const Vec3 from = position(low), along = position(high) - from;
    const double a = value_at(low), b = value_at(high);
    double t = a / (a - b);
    const double value = sample(view_at(low), from + along * t, band_).value;
    t = (value < 0) == (a < 0) ? t + (1 - t) * value / (value - b) : t * a / (a - value);
    // Kept off the nodes, so that no triangle shrinks to nothing.
    return from + along * std::fmin(0.96, std::fmax(0.04, t));
  }

  void march_cube(int x, int y, int z) {
    int corners[8], inside = 0;
    for (int i = 0; i < 8; ++i) {
      corners[i] = node(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
      inside += values_[corners[i]] < 0;
    }
    if (inside == 0 || inside == 8) return;
    // Six tetrahedra about the diagonal 0-7: one per order of the axes, all positively oriented.
    static const int kPaths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
    for (const auto& path : kPaths) {
      march_tetrahedron({corners[0], corners[path[0]], corners[path[1]], corners[7]});
    }
  }

  void march_tetrahedron(const std::array<int, 4>& t) {
    // Even permutations that bring the inside corners to the front, by the mask of inside corners.
    static const int kOrder[16][4] = {{0, 1, 2, 3}, {0, 1, 2, 3}, {1, 0, 3, 2}, {0, 1, 2, 3},
                                      {2, 3, 0, 1}, {0, 2, 3, 1}, {1, 2, 0, 3}, {3, 2, 1, 0},
                                      {3, 2, 1, 0}, {0, 3, 1, 2}, {1, 3, 2, 0}, {2, 3, 0, 1},
                                      {2, 3, 0, 1}, {1, 0, 3, 2}, {0, 1, 2, 3}, {0, 1, 2, 3}};
    int mask = 0, count = 0;
    for (int i = 0; i < 4; ++i) {
      if (values_[t[i]] < 0) mask |= 1 << i, ++count;
    }
    const int* order = kOrder[mask];
    const int a = t[order[0]], b = t[order[1]], c = t[order[2]], d = t[order[3]];
    // One vertex a statement: C++ fixes no order among arguments, and vertices are numbered in turn.
    if (count == 1) {
      const int ad = vertex_on(a, d);
      const int ac = vertex_on(a, c);
      add(vertex_on(a, b), ac, ad);
    } else if (count == 3) {  // a is the one outside
      const int ac = vertex_on(a, c);
      const int ad = vertex_on(a, d);
      add(vertex_on(a, b), ad, ac);
    } else if (count == 2) {
      const int ac = vertex_on(a, c), ad = vertex_on(a, d);
      const int bd = vertex_on(b, d), bc = vertex_on(b, c);
      add(ac, ad, bd);
      add(ac, bd, bc);
    }
  }

  void add(int a, int b, int c) { mesh_.triangles.push_back({a, b, c}); }

  void label() {
    for (const auto& t : mesh_.triangles) {
      const Vec3 middle =
          (mesh_.positions[t[0]] + mesh_.positions[t[1]] + mesh_.positions[t[2]]) * (1.0 / 3);
      const Vec3 at = (middle - origin_) * (1 / cell_);
      const SolidView& view =
          view_at(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z));
      mesh_.surfaces.push_back(surface_at(view, middle, band_));
    }
  }

  const Solid& solid_;
  double cell_, band_;
  Vec3 origin_;
  int size_[3], blocks_[3];
  std::vector<SolidView> views_;  // one a block
  std::vector<double> values_;
  std::vector<int> vertices_;  // seven edges start at every node
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh mesh_solid(const Solid& solid, double cell) {
  if (!(cell > 0)) throw RunError("the sampling grid of a solid needs a positive spacing");
  return Marcher(solid, cell).run();
}

void append(SurfaceMesh& mesh, const SurfaceMesh& more) {
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  mesh.surfaces.insert(mesh.surfaces.end(), more.surfaces.begin(), more.surfaces.end());
  for (const auto& t : more.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

}  // namespace rubble::generator
