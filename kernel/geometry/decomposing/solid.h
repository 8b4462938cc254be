// The inside of a triangle mesh, made ready for the question how much of a convex hull lies outside of it.
//
// Parallel lines through the mesh carry exact intervals of the inside. Cells of the same spacing know how far
// they are from the mesh. A cavity that nothing outside can reach counts as inside: nothing can lie in it.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"
#include "kernel/geometry/hull.h"
#include "kernel/geometry/voxel_grid.h"

namespace rubble {

class Solid {
 public:
  // resolution: cells along each side of a cube that is as large as the box around the mesh; range: 8 to 256. Lines
  // are along z, which should be the longest side. A mesh that is not closed, or that is
  // inside out, has as its inside what the cells that it passes through keep from the outside.
  Solid(const TriangleMesh& mesh, int resolution);

  // Whether the inside comes from the mesh itself, not from cells.
  bool is_exact() const { return exact_; }
  double volume() const { return volume_; }  // unit: m3
  double cell() const { return grid_.voxel; }  // edge length; unit: m
  // The cell about the point lies wholly inside.
  bool is_deep_inside(const Vec3& point) const;
  // Whether a point is inside, without error for a closed mesh.
  bool contains(const Vec3& point) const;

  Misfit measure(const Hull& hull) const;
  Misfit measure(const std::vector<Hull>& hulls) const;

 private:
  enum CellState : std::uint8_t { kInside, kSurface, kOutside };
  struct Interval {
    float low, high;  // z; unit: m
  };
  using Intervals = std::vector<Interval>;

  void mark_surface(const TriangleMesh& mesh);
  void flood_outside();
  void note_distances();
  void cross_mesh(const TriangleMesh& mesh);
  void cross_cells();
  void close_cavities(int column, Intervals& intervals) const;
  std::size_t columns() const { return std::size_t(grid_.size[0]) * std::size_t(grid_.size[1]); }
  const Interval* begin(std::size_t column) const { return intervals_.data() + starts_[column]; }
  const Interval* end(std::size_t column) const { return intervals_.data() + starts_[column + 1]; }
  void add_line(std::size_t column, const Intervals& hulls, Misfit& sum) const;
  double largest_distance(std::size_t column, double low, double high, double least) const;
  template <class Visit>
  void for_each_line(const Hull& hull, const Visit& visit) const;

  VoxelGrid grid_;
  bool exact_ = false;
  double volume_ = 0;
  std::vector<std::uint8_t> state_;     // of each cell
  std::vector<float> distance_;         // of the centre of each cell from the mesh, 0 inside; unit: m
  std::vector<float> most_distance_;    // of each column of cells; unit: m
  std::vector<float> line_x_, line_y_;  // of each column of cells: its line; unit: m
  std::vector<Interval> intervals_;     // of the inside, by column, ascending
  std::vector<std::uint32_t> starts_;   // of each column's intervals; one more at the end
  TriangleMesh mesh_;
};

}  // namespace rubble
