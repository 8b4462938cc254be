// Inside of decompose(): the solid as voxels, and volumes of hulls of boxes cut from it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble::decomposing {

using Cell3 = std::array<int, 3>;

// Half-open ranges of voxels.
struct Box {
  Cell3 low{}, high{};  // the first inside, the first beyond
};

class Voxels {
 public:
  // About `resolution` voxels along the longest side, with an empty margin of one all around.
  Voxels(const TriangleMesh& mesh, int resolution);

  const Cell3& size() const { return size_; }
  // Of the low corner of a voxel. unit: m
  Vec3 position(const Cell3& c) const {
    return origin_ + Vec3(c[0], c[1], c[2]) * edge_;
  }
  double edge() const { return edge_; }  // unit: m
  bool filled(int x, int y, int z) const { return state_[index(x, y, z)] != kOutside; }
  // All eight voxels about a lattice point are filled, and one of them lies wholly inside.
  bool surely_inside(const Cell3& corner) const;

  // Volume of the filled voxels of a box and of the hull of them, approximated by its extreme points
  // in 98 directions. unit: voxels
  struct Fill {
    double voxels = 0, hull = 0;
    double excess() const { return hull - voxels; }
  };
  Fill measure(const Box& box) const;
  // The box shrunk to its filled voxels; empty ranges when there is none.
  Box tight(const Box& box) const;

 private:
  enum State : std::uint8_t { kUnknown, kSurface, kOutside };
  std::size_t index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size_[1]) + std::size_t(y)) * std::size_t(size_[0]) +
           std::size_t(x);
  }
  void mark_triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  void flood_outside();

  Vec3 origin_;
  double edge_ = 0;
  Cell3 size_{};
  std::vector<std::uint8_t> state_;
};

// Volume of a hull; 0 for points that span none.
double calc_hull_volume(const std::vector<Vec3>& points);

}  // namespace rubble::decomposing
