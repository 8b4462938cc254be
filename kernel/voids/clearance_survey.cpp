#include "kernel/voids/clearance_survey.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "kernel/geometry/distance_transform.h"

namespace rubble {
namespace {

constexpr int kEdge = 176;  // of a tile; unit: cells
// In the edge between two walls, a ball of radius 1 leaves room for one of 0.29.
constexpr double kRoomInEdge = 0.3;

// Of some triangles of a surface the distance to the nearest.
class NearestTriangle {
 public:
  NearestTriangle(const Solids& solids, const VoxelSurface& surface, const Vec3& from)
      : solids_(solids), surface_(surface), from_(from) {}

  void consider(std::uint32_t seed) {  // number of a surface cell
    if (seed == kNoSeed) return;
    const std::uint32_t triangle = surface_.triangles[seed];
    if (triangle == last_) return;
    last_ = triangle;
    const Vec3 d = find_closest(solids_.triangle(triangle), from_) - from_;
    square_ = std::min(square_, dot(d, d));
  }
  float distance() const { return float(std::sqrt(square_)); }

 private:
  const Solids& solids_;
  const VoxelSurface& surface_;
  const Vec3 from_;
  std::uint32_t last_ = kNoSeed;
  double square_ = 1e12;
};

// Near is what is nearest to the cell itself or, since that was the nearest of surface *cells*, to one beside it.
class ClearanceSurvey {
 public:
  ClearanceSurvey(VoidSpace& space, const Solids& solids, ThreadPool& pool)
      : space_(space), solids_(solids), pool_(pool), all_{{0, 0, 0}, {}} {
    for (std::size_t k = 0; k < 3; ++k) all_.last[k] = space.grid.size[k] - 1;
  }

  // Of all cells. The nearest surface cells are found in the memory of the clearance, which replaces them by layers.
  void measure_all() {
    void* const nearest = space_.clearance.of_all().data();
    find_surface_in(all_);
    find_nearest_seeds(all_.grid(), surface_.cells, pool_, nearest);
    measure(all_, all_, nearest);
  }

  // Of some cells alone, tile by tile of the plan. Their distance is small, and so is what a tile needs around it.
  void measure_tiles(const std::function<void(double)>& report) {
    for (int y = 0; y <= all_.last[1]; y += kEdge) {
      for (int x = 0; x <= all_.last[0]; x += kEdge) {
        CellBox tile{{x, y, 0}, all_.last};
        tile.last[0] = std::min(tile.last[0], x + kEdge - 1), tile.last[1] = std::min(tile.last[1], y + kEdge - 1);
        int around = std::clamp(int(kRoomInEdge * space_.rolling_radius / space_.grid.voxel) + 3, 16, 64);
        CellBox box = widen(tile, around);
        for (;; around *= 2, box = widen(tile, around)) {
          find_surface_in(box);
          // Of each cell of the box the number of the nearest surface cell in it. Room for it is taken last.
          std::vector<std::uint32_t> nearest(box.grid().count());
          find_nearest_seeds(box.grid(), surface_.cells, pool_, nearest.data());
          if (!is_enough(tile, box, nearest, around)) continue;
          measure(tile, box, nearest.data());
          break;
        }
      }
      report(double(y) / space_.grid.size[1]);
    }
  }

 private:
  CellBox widen(CellBox box, int around) const {
    for (std::size_t k = 0; k < 3; ++k) {
      box.first[k] = std::max(0, box.first[k] - around);
      box.last[k] = std::min(all_.last[k], box.last[k] + around);
    }
    return box;
  }

  void find_surface_in(const CellBox& box) {
    surface_ = {};
    surface_ = find_surface(space_.grid, box, solids_, pool_);
  }

  // Whether no cell beyond the box can be the nearest to a cell of the tile or to one beside that.
  bool is_enough(const CellBox& tile, const CellBox& box, const std::vector<std::uint32_t>& nearest, int around) {
    if (box.first == all_.first && box.last == all_.last) return true;
    const std::int64_t most = std::int64_t(around - 1) * (around - 1);
    const VoxelGrid part = box.grid();
    std::atomic<bool> enough{true};
    pool_.run(part.size[2], 8, [&](int begin, int end) {
      BoxWalk cells(space_.grid, {{tile.first[0], tile.first[1], begin}, {tile.last[0], tile.last[1], end - 1}});
      for (int z = begin; z < end; ++z)
        for (int y = tile.first[1]; y <= tile.last[1]; ++y)
          for (int x = tile.first[0]; x <= tile.last[0]; ++x) {
            if (!space_.clearance.keeps(cells.next())) continue;
            const Cell c{x - box.first[0], y - box.first[1], z};
            const std::uint32_t seed = nearest[part.index(c)];
            std::int64_t square = 0;
            for (std::size_t k = 0; k < 3 && seed != kNoSeed; ++k)
              square += std::int64_t(surface_.cells[seed][k] - c[k]) * (surface_.cells[seed][k] - c[k]);
            if (seed == kNoSeed || square >= most) enough = false;
          }
    });
    return enough;
  }

  // Of the cells of the tile.
  void measure(const CellBox& tile, const CellBox& box, const void* nearest) {
    const VoxelGrid part = box.grid();
    const std::size_t row = std::size_t(part.size[0]), layer = row * std::size_t(part.size[1]);
    std::vector<std::uint32_t> below(layer), here(layer);
    for (int z = 0; z < part.size[2]; ++z) {
      const std::size_t first = std::size_t(z) * layer;
      std::memcpy(here.data(), static_cast<const char*>(nearest) + 4 * first, 4 * layer);
      pool_.run(tile.last[1] - tile.first[1] + 1, 8, [&](int begin, int end) {
        for (int y = tile.first[1] + begin; y < tile.first[1] + end; ++y)
          for (int x = tile.first[0]; x <= tile.last[0]; ++x) {
            const Cell cell{x, y, z};
            const std::size_t i = space_.grid.index(cell);
            if (!space_.clearance.keeps(i)) continue;
            const int left = x - box.first[0], front = y - box.first[1];
            const std::size_t c = std::size_t(left) + row * std::size_t(front);
            if (space_.kind[i] == CellKind::solid) {
              space_.clearance.set(i, 0);
              continue;
            }
            NearestTriangle found(solids_, surface_, space_.grid.centre(cell));
            found.consider(here[c]);
            if (left > 0) found.consider(here[c - 1]);
            if (left + 1 < part.size[0]) found.consider(here[c + 1]);
            if (front > 0) found.consider(here[c - row]);
            if (front + 1 < part.size[1]) found.consider(here[c + row]);
            if (z > 0) found.consider(below[c]);
            if (z + 1 < part.size[2]) found.consider(seed_at(nearest, first + layer + c));
            space_.clearance.set(i, found.distance());
          }
      });
      std::swap(below, here);
    }
  }

  VoidSpace& space_;
  const Solids& solids_;
  ThreadPool& pool_;
  CellBox all_;           // of the grid
  VoxelSurface surface_;  // of the box at hand
};

}  // namespace

void measure_clearance(VoidSpace& space, const Solids& solids, ThreadPool& pool,
                       const std::function<void(double)>& report) {
  ClearanceSurvey survey(space, solids, pool);
  if (space.clearance.is_sparse())
    survey.measure_tiles(report);
  else
    survey.measure_all();
  report(1);
}

}  // namespace rubble
