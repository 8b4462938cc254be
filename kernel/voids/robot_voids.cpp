#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/geometry/distance_transform.h"
#include "kernel/voids/cell_box.h"
#include "kernel/voids/place_runs.h"
#include "kernel/voids/void_map.h"
#include "kernel/voids/ways_from.h"

namespace rubble {
namespace {

constexpr int kTile = 128;  // edge of a part that is given to voids at a time, at least; unit: cells

class Finder {
 public:
  Finder(const VoidSpace& space, double radius, int threads)
      : space_(space), radius_(float(radius)), pool_(threads), places_(space, radius_) {
    result_.radius = radius;
  }

  RobotVoids run() {
    for (CellRuns& places : places_.list_voids()) {
      result_.voids.emplace_back();
      result_.voids.back().places = std::move(places);
    }
    assign_cells();
    find_depths();
    for (std::size_t i = 0; i < result_.voids.size(); ++i) describe(result_.voids[i], i);
    drop_dents();
    for (Void& v : result_.voids) {
      v.volume = double(v.cells.size()) * space_.cell_volume();
      result_.volume += v.volume;
      if (!v.entrances.empty()) result_.reachable_volume += v.volume;
    }
    std::stable_sort(result_.voids.begin(), result_.voids.end(),
                     [](const Void& a, const Void& b) { return a.volume > b.volume; });
    return std::move(result_);
  }

 private:
  // Void cells within the robot's radius of a place belong to that place's void. Half a voxel is
  // added, since the centre of a cell at a wall is that far from it.
  void assign_cells() {
    const Cell& n = space_.grid.size;
    const double reach = radius_ / space_.grid.voxel + 0.5;
    const int beside = int(std::ceil(reach)), step = std::max(kTile, 4 * beside);
    cells_.resize(result_.voids.size());
    for (int y = 0; y < n[1]; y += step)
      for (int x = 0; x < n[0]; x += step)
        assign_tile({{x, y, 0}, {std::min(x + step, n[0]) - 1, std::min(y + step, n[1]) - 1, n[2] - 1}}, beside,
                    reach);
    for (std::size_t v = 0; v < cells_.size(); ++v) result_.voids[v].cells = CellRuns(std::move(cells_[v]));
  }

  // beside: how far around the tile the nearest place may be. reach: of a place; both in cells.
  void assign_tile(const CellBox& tile, int beside, double reach) {
    const VoxelGrid& grid = space_.grid;
    CellBox box = tile;
    for (std::size_t k = 0; k < 2; ++k) {
      box.first[k] = std::max(0, tile.first[k] - beside);
      box.last[k] = std::min(grid.size[k] - 1, tile.last[k] + beside);
    }
    const std::vector<Cell> seeds = list_edges(box);
    const VoxelGrid part = box.grid();
    const auto nearest = find_nearest_seeds(part, seeds, pool_);
    for (int z = tile.first[2]; z <= tile.last[2]; ++z)
      for (int y = tile.first[1]; y <= tile.last[1]; ++y)
        for (int x = tile.first[0]; x <= tile.last[0]; ++x) {
          const std::size_t i = grid.index({x, y, z});
          if (space_.kind[i] != CellKind::free_void) continue;
          const PlaceRuns::Run* place = places_.find(i);
          const Cell c{x - box.first[0], y - box.first[1], z};
          const std::uint32_t seed = nearest[part.index(c)];
          if (!place && seed != kNoSeed) {
            const Cell& s = seeds[seed];
            double square = 0;
            for (std::size_t k = 0; k < 3; ++k) square += double(s[k] - c[k]) * (s[k] - c[k]);
            if (square <= reach * reach)
              place = places_.find(grid.index({s[0] + box.first[0], s[1] + box.first[1], s[2]}));
          }
          if (place) add_cell(cells_[place->label], std::uint32_t(i));
        }
  }

  static void add_cell(std::vector<CellRun>& runs, std::uint32_t cell) {
    if (!runs.empty() && runs.back().first + runs.back().count == cell)
      ++runs.back().count;
    else
      runs.push_back({cell, 1});
  }

  // The places at the edges of the voids, from the first cell of the box; ascending.
  std::vector<Cell> list_edges(const CellBox& box) const {
    const VoxelGrid& grid = space_.grid;
    std::vector<Cell> edges;
    for (int z = box.first[2]; z <= box.last[2]; ++z)
      for (int y = box.first[1]; y <= box.last[1]; ++y)
        for (int x = box.first[0]; x <= box.last[0]; ++x) {
          const std::size_t i = grid.index({x, y, z});
          if (space_.kind[i] != CellKind::free_void || !places_.find(i)) continue;
          bool inner = true;
          for_each_neighbour(grid, i, [&](std::size_t k) { inner = inner && places_.find(k); });
          if (!inner) edges.push_back({x - box.first[0], y - box.first[1], z});
        }
    return edges;
  }

  // For each column the height of the highest cell that is not outside.
  void find_depths() {
    const Cell& n = space_.grid.size;
    envelope_.assign(std::size_t(n[0]) * std::size_t(n[1]), 0);
    std::size_t i = 0;
    for (int z = 0; z < n[2]; ++z)
      for (int& height : envelope_)
        if (space_.kind[i++] != CellKind::outside) height = z + 1;
  }

  double find_depth(std::size_t i) const {
    const std::size_t layer = envelope_.size();
    return (envelope_[i % layer] - double(i / layer) - 0.5) * space_.grid.voxel;
  }

  void describe(Void& v, std::size_t number) {
    std::size_t widest = v.places.front(), lowest = widest;
    for (const std::uint32_t i : v.places) {
      if (space_.clearance[i] > space_.clearance[widest]) widest = i;
      if (find_depth(i) > find_depth(lowest)) lowest = i;
    }
    v.widest = space_.grid.centre(widest);
    v.widest_radius = space_.clearance[widest];
    v.depth = find_depth(lowest);
    v.deepest = space_.grid.centre(lowest);
    const std::vector<std::uint32_t> openings = find_openings(v);
    group_entrances(v, openings);
    if (!openings.empty()) find_deepest(v, openings, std::uint32_t(number));
  }

  void drop_dents() {
    auto& voids = result_.voids;
    voids.erase(std::remove_if(voids.begin(), voids.end(),
                               [&](const Void& v) {
                                 return !v.entrances.empty() && v.path_length < 2 * result_.radius;
                               }),
                voids.end());
  }

  // Places from which one step leads outside without getting narrower than the robot.
  std::vector<std::uint32_t> find_openings(const Void& v) const {
    std::vector<std::uint32_t> openings;
    for (const std::uint32_t i : v.places)
      if (calc_outward(i).first > 0) openings.push_back(i);
    return openings;
  }

  // How many faces lead outside, and the sum of their normals.
  std::pair<int, Vec3> calc_outward(std::size_t i) const {
    int faces = 0;
    Vec3 sum;
    const Vec3 here = space_.grid.centre(i);
    for_each_neighbour(space_.grid, i, [&](std::size_t k) {
      if (space_.kind[k] != CellKind::outside || space_.clearance[k] < radius_) return;
      ++faces;
      sum += (space_.grid.centre(k) - here) * (1 / space_.grid.voxel);
    });
    return {faces, sum};
  }

  // Openings that touch each other, be it by a corner, are one entrance.
  void group_entrances(Void& v, const std::vector<std::uint32_t>& openings) const {
    std::vector<char> done(openings.size(), 0);
    for (std::size_t first = 0; first < openings.size(); ++first) {
      if (done[first]) continue;
      std::vector<std::size_t> group{first};
      done[first] = 1;
      for (std::size_t k = 0; k < group.size(); ++k) {
        for_each_around(space_.grid, openings[group[k]], [&](std::size_t n, double) {
          const auto found = std::lower_bound(openings.begin(), openings.end(), n);
          const std::size_t at = std::size_t(found - openings.begin());
          if (found == openings.end() || *found != n || done[at]) return;
          done[at] = 1;
          group.push_back(at);
        });
      }
      v.entrances.push_back(make_entrance(v, openings, group));
    }
    std::stable_sort(v.entrances.begin(), v.entrances.end(),
                     [](const Entrance& a, const Entrance& b) { return a.radius > b.radius; });
  }

  Entrance make_entrance(const Void& v, const std::vector<std::uint32_t>& openings,
                         const std::vector<std::size_t>& group) const {
    Entrance e;
    Vec3 outward;
    std::size_t widest = openings[group.front()];
    for (const std::size_t k : group) {
      const std::size_t i = openings[k];
      e.openings.push_back(std::uint32_t(i));
      outward += calc_outward(i).second;
      if (space_.clearance[i] > space_.clearance[widest] ||
          (space_.clearance[i] == space_.clearance[widest] && i < widest))
        widest = i;
    }
    e.position = space_.grid.centre(widest);
    e.radius = space_.clearance[widest];
    e.area = norm(outward) * space_.grid.voxel * space_.grid.voxel;
    e.inward = norm(outward) > 0 ? normalized(-outward) : normalized(v.widest - e.position);
    if (norm(e.inward) == 0) e.inward = {0, 0, -1};
    return e;
  }

  // Dijkstra from all openings at once over the void's places.
  void find_deepest(Void& v, const std::vector<std::uint32_t>& openings, std::uint32_t number) {
    const std::vector<double> length =
        calc_ways_from(space_.grid, openings, v.places.size(), [&](std::size_t k) {
          const PlaceRuns::Run* place = places_.find(k);
          return place && place->label == number ? place->rank + std::uint32_t(k - place->first) : kNoSlot;
        });
    const auto farthest = std::max_element(length.begin(), length.end());
    v.path_length = *farthest * space_.grid.voxel;
    v.deepest = space_.grid.centre(v.places[std::size_t(farthest - length.begin())]);
  }

  const VoidSpace& space_;
  const float radius_;
  ThreadPool pool_;
  const PlaceRuns places_;
  std::vector<std::vector<CellRun>> cells_;  // of each void
  std::vector<int> envelope_;
  RobotVoids result_;
};

}  // namespace

std::vector<double> calc_ways_in(const VoidSpace& space, const Void& v) {
  std::vector<std::uint32_t> openings;
  for (const Entrance& e : v.entrances)
    openings.insert(openings.end(), e.openings.begin(), e.openings.end());
  const CellSlots slot(space.grid.count(), std::vector<std::uint32_t>(v.places.begin(), v.places.end()));
  std::vector<double> ways = calc_ways_from(space.grid, openings, v.places.size(),
                                            [&slot](std::size_t k) { return slot[k]; });
  for (double& way : ways) way *= space.grid.voxel;
  return ways;
}

RobotVoids find_robot_voids(const VoidSpace& space, double radius, int threads) {
  return Finder(space, radius, threads).run();
}

void add_bottlenecks(const VoidSpace& space, const WidestPaths& widest, RobotVoids& robot) {
  for (Void& v : robot.voids) {
    const std::size_t cell = space.grid.index(space.grid.find_cell(v.widest));
    v.bottleneck_radius = widest.radius(space, cell);
    const std::uint32_t narrowest = widest.narrowest[(*widest.cells)[cell]];
    if (narrowest != kNoCell) v.bottleneck = space.grid.centre(narrowest);
  }
}

}  // namespace rubble
