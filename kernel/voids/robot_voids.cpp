#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/geometry/distance_transform.h"
#include "kernel/voids/void_map.h"
#include "kernel/voids/ways_from.h"

namespace rubble {
namespace {

constexpr std::uint32_t kUnlabelled = kNoSlot;
constexpr int kLayers = 32;  // of cells that are given to voids at a time, at least

class Finder {
 public:
  Finder(const VoidSpace& space, const WidestPaths& widest, double radius, int threads)
      : space_(space), widest_(widest), radius_(float(radius)), pool_(threads) {
    result_.radius = radius;
    slots_ = CellSlots(space.kind.size(), [&](std::size_t i) { return is_place(i); });
    label_.assign(slots_.count(), kUnlabelled);
  }

  RobotVoids run() {
    label_places();
    assign_cells();
    find_depths();
    rank_.resize(label_.size());
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
  bool is_place(std::size_t i) const {
    return space_.kind[i] == CellKind::free_void && space_.clearance[i] >= radius_;
  }

  // Of a place: the number of its void. Of any other cell kUnlabelled.
  std::uint32_t label_at(std::size_t i) const {
    const std::uint32_t slot = slots_[i];
    return slot == kNoSlot ? kUnlabelled : label_[slot];
  }

  // Connected places by their faces.
  void label_places() {
    std::vector<std::uint32_t> front;
    const auto is_new = [&](std::size_t i) { return slots_[i] != kNoSlot && label_[slots_[i]] == kUnlabelled; };
    for (std::size_t i = 0; i < space_.kind.size(); ++i) {
      if (!is_new(i)) continue;
      const std::uint32_t label = std::uint32_t(result_.voids.size());
      Void found;
      const auto visit = [&](std::size_t k) {
        if (!is_new(k)) return;
        label_[slots_[k]] = label;
        front.push_back(std::uint32_t(k));
      };
      visit(i);
      while (!front.empty()) {
        const std::uint32_t at = front.back();
        front.pop_back();
        found.places.push_back(at);
        for_each_neighbour(space_.grid, at, visit);
      }
      std::sort(found.places.begin(), found.places.end());
      result_.voids.push_back(std::move(found));
    }
  }

  // Void cells within the robot's radius of a place belong to that place's void. Half a voxel is
  // added, since the centre of a cell at a wall is that far from it.
  void assign_cells() {
    const VoxelGrid& grid = space_.grid;
    std::vector<Cell> seeds;  // the places at the edges of the voids, layer by layer
    for (std::size_t i = 0; i < space_.kind.size(); ++i) {
      const std::uint32_t label = label_at(i);
      if (label == kUnlabelled) continue;
      bool inner = true;
      for_each_neighbour(grid, i, [&](std::size_t k) { inner = inner && label_at(k) == label; });
      if (!inner) seeds.push_back(grid.cell(i));
    }
    // Some layers at a time with those beside them that a robot's radius reaches: for all at once
    // the nearest places would take four bytes a cell.
    const double reach = radius_ / grid.voxel + 0.5;
    const int beside = int(std::ceil(reach)), step = std::max(kLayers, 2 * beside);
    for (int first = 0; first < grid.size[2]; first += step)
      assign_layers(first, std::min(first + step, grid.size[2]), beside, reach, seeds);
  }

  // first, last: layers [first, last). beside: layers to either side that may have the nearest
  // place. reach: of a place; both in cells. seeds: ascending.
  void assign_layers(int first, int last, int beside, double reach,
                     const std::vector<Cell>& seeds) {
    const VoxelGrid& grid = space_.grid;
    const int low = std::max(0, first - beside), high = std::min(grid.size[2], last + beside);
    const auto below = [](const Cell& seed, int z) { return seed[2] < z; };
    const auto begin = std::lower_bound(seeds.begin(), seeds.end(), low, below);
    const auto end = std::lower_bound(begin, seeds.end(), high, below);
    VoxelGrid part = grid;
    part.size[2] = high - low;
    std::vector<Cell> own(begin, end);
    for (Cell& seed : own) seed[2] -= low;
    const auto nearest = find_nearest_seeds(part, own, pool_);
    const std::size_t lowest = grid.index({0, 0, low});
    for (std::size_t i = grid.index({0, 0, first}); i < grid.index({0, 0, last}); ++i) {
      if (space_.kind[i] != CellKind::free_void) continue;
      std::uint32_t v = label_at(i);
      const std::uint32_t seed = nearest[i - lowest];
      if (v == kUnlabelled && seed != kNoSeed) {
        const Cell c = part.cell(i - lowest), &s = own[seed];
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) square += double(s[k] - c[k]) * (s[k] - c[k]);
        if (square <= reach * reach) v = label_at(lowest + part.index(s));
      }
      if (v != kUnlabelled) result_.voids[v].cells.push_back(std::uint32_t(i));
    }
  }

  // For each column the height of the highest cell that is not outside.
  void find_depths() {
    const Cell& n = space_.grid.size;
    const std::size_t layer = std::size_t(n[0]) * std::size_t(n[1]);
    envelope_.assign(layer, 0);
    for (std::size_t i = 0; i < space_.kind.size(); ++i) {
      if (space_.kind[i] != CellKind::outside) envelope_[i % layer] = int(i / layer) + 1;
    }
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
    const std::size_t slot = widest_.cells[widest];
    v.bottleneck_radius = widest_.radius[slot];
    if (widest_.narrowest[slot] != kNoCell)
      v.bottleneck = space_.grid.centre(widest_.narrowest[slot]);
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
    for (std::size_t k = 0; k < v.places.size(); ++k)
      rank_[slots_[v.places[k]]] = std::uint32_t(k);
    const std::vector<double> length =
        calc_ways_from(space_.grid, openings, v.places.size(), [&](std::size_t k) {
          const std::uint32_t slot = slots_[k];
          return slot != kNoSlot && label_[slot] == number ? rank_[slot] : kNoSlot;
        });
    const auto farthest = std::max_element(length.begin(), length.end());
    v.path_length = *farthest * space_.grid.voxel;
    v.deepest = space_.grid.centre(v.places[std::size_t(farthest - length.begin())]);
  }

  const VoidSpace& space_;
  const WidestPaths& widest_;
  const float radius_;
  ThreadPool pool_;
  CellSlots slots_;                   // of all places
  std::vector<std::uint32_t> label_;  // of each place: the number of its void
  std::vector<std::uint32_t> rank_;   // of each place: where in its void's list it is
  std::vector<int> envelope_;
  RobotVoids result_;
};

}  // namespace

std::vector<double> calc_ways_in(const VoidSpace& space, const Void& v) {
  std::vector<std::uint32_t> openings;
  for (const Entrance& e : v.entrances)
    openings.insert(openings.end(), e.openings.begin(), e.openings.end());
  const CellSlots slot(space.grid.count(), v.places);
  std::vector<double> ways = calc_ways_from(space.grid, openings, v.places.size(),
                                            [&slot](std::size_t k) { return slot[k]; });
  for (double& way : ways) way *= space.grid.voxel;
  return ways;
}

RobotVoids find_robot_voids(const VoidSpace& space, const WidestPaths& widest, double radius,
                            int threads) {
  return Finder(space, widest, radius, threads).run();
}

}  // namespace rubble
