// What an exploring robot knows of space: cells that are unknown, free or solid, and where it has room among them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "app/search/search_agent.h"
#include "kernel/geometry/voxel_grid.h"

namespace rubble {

class ExplorationMap {
 public:
  enum State : std::uint8_t { kUnknown, kFree, kSolid };
  static constexpr double kVoxel = 0.1;  // unit: m

  // Of the pile and what is around it, all unknown.
  explicit ExplorationMap(const SearchBriefing& briefing);

  const VoxelGrid& grid() const { return grid_; }
  State state(std::size_t cell) const { return state_[cell]; }
  // The cell a place is in, or the nearest one to it.
  std::size_t find(const Vec3& place) const;

  // A cell outside of the map is left out.
  void set(const Cell& cell, State state);
  void set_free_if_unknown(const Cell& cell);
  // The robot's own body is where nothing else is.
  void add_body(const Vec3& place);
  // No way leads here, whatever is seen later.
  void block(std::size_t cell) { ++near_solid_[cell]; }

  // Known to be free, with room for the robot on all sides as far as they are known.
  bool is_way(std::size_t cell) const { return state_[cell] == kFree && near_solid_[cell] == 0; }
  bool borders_unknown(std::size_t cell) const;
  bool has_roof(std::size_t cell) const;

 private:
  template <typename Visit>
  void for_each_within(const Cell& middle, double reach, const Visit& visit) const;

  double radius_;
  VoxelGrid grid_;
  std::vector<State> state_;
  std::vector<std::uint16_t> near_solid_;  // solid cells that are too near for the robot
};

// From depth pictures to what is known of space: by rays over a grid, or by OctoMap. Internal to app/search.

// Takes in what is seen.
using DepthMapping = std::function<void(const SearchObservation&, ExplorationMap&)>;

// What a ray passed is free, unless it was solid; where it ended is solid for good. Right as long as depth is exact.
DepthMapping make_ray_mapping(const SearchRules& rules);
// Each cell has a probability of OctoMap's occupancy tree: what was seen may be seen otherwise later.
DepthMapping make_octomap_mapping(const SearchRules& rules);

}  // namespace rubble
