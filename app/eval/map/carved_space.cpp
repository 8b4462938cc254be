#include "app/eval/map/carved_space.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/eval/scores/space_key.h"
#include "kernel/voids/cell_walk.h"
#include "kernel/voids/void_map.h"

namespace rubble {
namespace {

// The mean of the points in each cell of the grid, which goes on beyond its borders here.
std::vector<Vec3> thin_out(const VoxelGrid& grid, const std::vector<Vec3>& points) {
  std::vector<std::pair<std::int64_t, Vec3>> sorted;
  for (const Vec3& p : points) {
    if (!has_space_key(p)) continue;
    const Cell c = grid.find_cell(p);
    sorted.push_back({space_key(c[0], c[1], c[2]), p});
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec3> means;
  for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
    Vec3 sum;
    for (last = first; last < sorted.size() && sorted[last].first == sorted[first].first; ++last)
      sum += sorted[last].second;
    means.push_back(sum * (1.0 / double(last - first)));
  }
  return means;
}

bool may_be_measured(const Vec3& point, std::size_t frame, const PileQueries& truth,
                     const RecordedViews& views) {
  if (!views.has_in_picture(frame, point)) return false;
  const Vec3& eye = views.world_from_optical[frame].translation;
  const double length = distance(eye, point);
  return length <= kCarveSlack || !truth.cast_ray(eye, point - eye, length - kCarveSlack);
}

}  // namespace

CarvedSpace::CarvedSpace(const VoxelGrid& grid, const std::vector<Vec3>& map,
                         const PileQueries& truth, const RecordedViews& views, ThreadPool& pool)
    : grid_(grid), state_(grid.count(), State::unknown) {
  const std::vector<Vec3> surface = thin_out(grid, map);
  for (const Vec3& p : map)
    if (grid.contains(grid.find_cell(p))) state_[grid.index(grid.find_cell(p))] = State::surface;
  pool.run(int(views.world_from_optical.size()), 1, [&](int begin, int end) {
    for (std::size_t f = std::size_t(begin); f < std::size_t(end); ++f)
      for (const Vec3& point : surface)
        if (may_be_measured(point, f, truth, views))
          carve(views.world_from_optical[f].translation, point);
  });
}

// Several threads carve at once: what is surface stays so, and all else that they write is `free`.
void CarvedSpace::carve(const Vec3& from, const Vec3& to) {
  walk_cells(grid_, from, to - from, 1, [&](std::size_t cell) {
    State* const state = &state_[cell];
    State now;
    __atomic_load(state, &now, __ATOMIC_RELAXED);
    if (now == State::surface) return false;
    now = State::free;
    __atomic_store(state, &now, __ATOMIC_RELAXED);
    return true;
  });
}

bool CarvedSpace::is_known(std::size_t cell) const {
  if (state_[cell] != State::surface) return is_free(cell);
  const Cell c = grid_.cell(cell);
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c[0] + dx, c[1] + dy, c[2] + dz};
        if (grid_.contains(n) && is_free(grid_.index(n))) return true;
      }
  return false;
}

bool CarvedSpace::has_room(std::size_t cell, double radius) const {
  const Cell c = grid_.cell(cell);
  const double reach = std::max(0.0, radius / grid_.voxel - 0.5 * std::sqrt(3.0));
  const int far = int(reach);
  for (int dz = -far; dz <= far; ++dz)
    for (int dy = -far; dy <= far; ++dy)
      for (int dx = -far; dx <= far; ++dx) {
        if (dx * dx + dy * dy + dz * dz > reach * reach) continue;
        const Cell n{c[0] + dx, c[1] + dy, c[2] + dz};
        if (!grid_.contains(n) || !is_free(grid_.index(n))) return false;
      }
  return true;
}

namespace {

// The robot fits on both sides of the border between void and outside.
bool is_found(const Entrance& entrance, double radius, const VoidSpace& space,
              const CarvedSpace& carved) {
  for (const std::uint32_t i : entrance.openings) {
    if (!carved.has_room(i, radius)) continue;
    bool found = false;
    for_each_neighbour(space.grid, i, [&](std::size_t k) {
      found = found || (space.kind[k] == CellKind::outside && space.clearance[k] >= radius &&
                        carved.has_room(k, radius));
    });
    if (found) return true;
  }
  return false;
}

}  // namespace

FoundVoids find_known_voids(const VoidSpace& space, const RobotVoids& robot,
                            const CarvedSpace& carved) {
  FoundVoids found;
  for (const Void& v : robot.voids) {
    const auto known = std::count_if(v.cells.begin(), v.cells.end(),
                                     [&](std::uint32_t i) { return carved.is_known(i); });
    found.volume += double(known) * space.cell_volume();
    found.entrances.emplace_back();
    for (const Entrance& entrance : v.entrances)
      found.entrances.back().push_back(is_found(entrance, robot.radius, space, carved));
  }
  return found;
}

double calc_known_volume(const VoidSpace& space, const CarvedSpace& carved) {
  double known = 0;
  for (std::size_t i = 0; i < space.kind.size(); ++i)
    known += space.kind[i] == CellKind::free_void && carved.is_known(i);
  return known * space.cell_volume();
}

}  // namespace rubble
