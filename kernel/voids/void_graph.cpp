#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "kernel/voids/cell_slots.h"
#include "kernel/voids/void_map.h"

namespace rubble {
namespace {

constexpr std::uint32_t kOutside = 0xfffffffeu;
constexpr std::uint32_t kUnvisited = 0xffffffffu;
constexpr double kSortedPerVoxel = 16;  // levels of clearance that are sorted one by one

// Floods the void from its widest places downwards; each place that is reached from none before it
// is a peak. Where two floods meet is the throat between them, or, when one of the peaks hardly
// stands out, that peak joins the other (Edelsbrunner, Letscher and Zomorodian 2002, "Topological
// persistence and simplification").
class Watershed {
 public:
  Watershed(const VoidSpace& space, double smallest, double persistence)
      : space_(space), persistence_(persistence) {
    sort_cells(float(smallest));
    slots_ = CellSlots(space.kind.size(), order_);
    basin_of_.assign(order_.size(), kUnvisited);
  }

  VoidGraph run() {
    for (const std::uint32_t i : order_) visit(i);
    return collect();
  }

 private:
  // The widest first, then by index: by levels of clearance, which are sorted one by one, as all at once would take
  // twice the memory.
  void sort_cells(float smallest) {
    const auto visit_wide = [&](const auto& visit) {
      for (std::size_t i = 0; i < space_.kind.size(); ++i) {
        if (space_.kind[i] != CellKind::free_void) continue;
        const float clearance = space_.clearance[i];
        if (clearance >= smallest) visit(std::uint32_t(i), clearance);
      }
    };
    std::vector<std::size_t> begin;  // of the levels in turn, the narrowest last
    const auto level_of = [&](float clearance) { return std::size_t(clearance / space_.grid.voxel * kSortedPerVoxel); };
    visit_wide([&](std::uint32_t, float clearance) {
      if (begin.size() <= level_of(clearance)) begin.resize(level_of(clearance) + 1);
      ++begin[level_of(clearance)];
    });
    std::size_t count = 0;
    for (std::size_t level = begin.size(); level-- > 0;) count += std::exchange(begin[level], count);
    order_.resize(count);
    visit_wide([&](std::uint32_t i, float clearance) { order_[begin[level_of(clearance)]++] = i; });
    std::vector<std::pair<float, std::uint32_t>> cells;
    std::size_t first = 0;
    for (std::size_t level = begin.size(); level-- > 0;) {
      cells.clear();
      for (std::size_t k = first; k < begin[level]; ++k) cells.push_back({-space_.clearance[order_[k]], order_[k]});
      std::sort(cells.begin(), cells.end());
      for (const auto& cell : cells) order_[first++] = cell.second;
    }
  }

  struct Basin {
    std::uint32_t peak;
    std::uint32_t parent;
  };
  struct Meeting {
    std::uint32_t a, b, cell;
  };

  std::uint32_t find(std::uint32_t basin) {
    while (basins_[basin].parent != basin) {
      basins_[basin].parent = basins_[basins_[basin].parent].parent;
      basin = basins_[basin].parent;
    }
    return basin;
  }

  void visit(std::uint32_t i) {
    around_.clear();
    bool at_outside = false;
    for_each_neighbour(space_.grid, i, [&](std::size_t k) {
      if (space_.kind[k] == CellKind::outside) at_outside = true;
      const std::uint32_t slot = slots_[k];
      if (slot == kNoSlot || basin_of_[slot] == kUnvisited) return;
      around_.push_back(find(basin_of_[slot]));
    });
    if (around_.empty()) {
      basins_.push_back({i, std::uint32_t(basins_.size())});
      around_.push_back(std::uint32_t(basins_.size() - 1));
    }
    std::sort(around_.begin(), around_.end());
    around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
    // The widest peak is the oldest basin, the one with the lowest number.
    const std::uint32_t widest = around_.front();
    basin_of_[slots_[i]] = widest;
    for (const std::uint32_t basin : around_)
      if (basin != widest) meet(widest, basin, i);
    if (at_outside) meetings_.push_back({widest, kOutside, i});
  }

  void meet(std::uint32_t wider, std::uint32_t narrower, std::uint32_t cell) {
    const float peak = space_.clearance[basins_[narrower].peak];
    if (peak - space_.clearance[cell] < persistence_) {
      basins_[narrower].parent = wider;
    } else {
      meetings_.push_back({wider, narrower, cell});
    }
  }

  VoidGraph collect() {
    VoidGraph graph;
    std::map<std::uint32_t, int> number;  // of a basin that stands: its chamber
    for (std::uint32_t b = 0; b < basins_.size(); ++b) {
      if (find(b) != b) continue;
      number[b] = int(graph.chambers.size());
      graph.chambers.push_back(
          {space_.grid.centre(basins_[b].peak), space_.clearance[basins_[b].peak], 0});
    }
    for (const std::uint32_t i : order_)
      graph.chambers[std::size_t(number[find(basin_of_[slots_[i]])])].volume +=
          space_.cell_volume();
    // Meetings come widest first, so the first of a pair is its throat.
    std::map<std::pair<int, int>, bool> known;
    for (const Meeting& m : meetings_) {
      int a = number[find(m.a)], b = m.b == kOutside ? -1 : number[find(m.b)];
      if (a == b) continue;
      if (b >= 0 && a > b) std::swap(a, b);
      if (!known.insert({{a, b}, true}).second) continue;
      graph.throats.push_back({a, b, space_.grid.centre(m.cell), space_.clearance[m.cell]});
    }
    return graph;
  }

  const VoidSpace& space_;
  const double persistence_;
  std::vector<std::uint32_t> order_;
  CellSlots slots_;                      // of the cells in order_
  std::vector<std::uint32_t> basin_of_;  // of each of them
  std::vector<Basin> basins_;
  std::vector<Meeting> meetings_;
  std::vector<std::uint32_t> around_;  // the basins beside the cell at hand
};

}  // namespace

VoidGraph find_graph(const VoidSpace& space, double smallest, double persistence) {
  return Watershed(space, smallest, persistence).run();
}

}  // namespace rubble
