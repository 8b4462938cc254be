// A settled pile with victims as the search benchmark sees it: what rays meet, where the robot has room, and what
// it could find.
#pragma once

#include <memory>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/search/search_rules.h"
#include "app/victims/place_victims.h"
#include "kernel/model/pile_state.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_map.h"
#include "render/rays/depth_rays.h"

namespace rubble {

// Of depth and thermal picture.
Intrinsics search_camera(const SearchRules& rules);

// A victim with what the score needs to know of it.
struct SearchTarget {
  Victim victim;
  Vec3 lookout;         // a place of the robot near it; unit: m
  double shortest = 0;  // of the robot's centre from the start to the lookout; unit: m
};

class SearchWorld {
 public:
  // Throws InputError: no victims, no void that the robot can enter.
  SearchWorld(const ResolvedMission& mission, const PileState& pile, const SearchRules& rules, int threads);

  const SearchRules& rules() const { return rules_; }
  const std::vector<SearchTarget>& targets() const { return targets_; }
  const SearchPose& start() const { return start_; }
  const Aabb& bounds() const { return bounds_; }  // of the pile; unit: m
  // Around pile and air; its first robot is the rules'.
  const VoidMap& voids() const { return map_; }
  // Cells of voids that the robot covers and that it can enter; ascending.
  const std::vector<std::uint32_t>& reachable_cells() const { return reachable_; }

  // Whether the robot has room there.
  bool is_free(const Vec3& place) const;
  // As DepthRays::cast.
  void look(const Pose& world_from_camera, std::vector<float>& depth, std::vector<std::int32_t>& pieces) const;
  const DepthRays& rays() const { return rays_; }
  bool is_victim(std::int32_t piece) const { return piece >= 0 && is_victim_[std::size_t(piece)]; }

 private:
  void find_start();
  void find_targets(const PileState& pile);

  SearchRules rules_;
  PileQueries queries_;
  RayWorld world_;
  DepthRays rays_;
  mutable ThreadPool pool_;
  VoidMap map_;
  Aabb bounds_;
  SearchPose start_;
  std::vector<SearchTarget> targets_;
  std::vector<std::uint32_t> reachable_;
  std::vector<std::uint8_t> is_victim_;  // by piece
};

}  // namespace rubble
