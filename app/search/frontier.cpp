// Frontier exploration (Yamauchi 1997) in three dimensions: to the nearest place that is known to be free and
// borders on what is not known, on a map that the robot makes from its depth pictures.
#include <algorithm>
#include <queue>

#include "app/search/baselines.h"
#include "app/search/exploration_map.h"

namespace rubble {
namespace {

constexpr double kVoxel = ExplorationMap::kVoxel;
constexpr double kOpenAir = 3;     // how much farther a place under the sky seems; unit: m
constexpr int kLookAround = 40;    // steps at a frontier before it is given up

class Frontier : public SearchAgent {
 public:
  Frontier(const SearchBriefing& briefing, DepthMapping mapping)
      : rules_(briefing.rules), heat_(briefing), map_(briefing), add_depth_(std::move(mapping)),
        given_up_(map_.grid().count(), 0) {}

  SearchAction act(const SearchObservation& seen) override {
    SearchAction action;
    action.reports = heat_.update(seen);
    map_.add_body(seen.pose.position);
    add_depth_(seen, map_);
    if (seen.stopped) block_ahead(seen.pose);
    if (way_.empty() || !is_frontier(way_.back()) || seen.stopped) plan(seen.pose.position);
    if (way_.empty()) {
      // Nothing is left: look around once more, then give up what was given up.
      action.command.turn = rules_.turn_rate;
      if (++idle_ % kLookAround == 0) std::fill(given_up_.begin(), given_up_.end(), 0);
      return action;
    }
    action.command = follow(seen.pose);
    return action;
  }

 private:
  // What cannot be seen so near: the place where it was stopped.
  void block_ahead(const SearchPose& pose) {
    if (way_.empty()) return;
    given_up_[way_.back()] = 1;
    const std::size_t next = way_[std::min(step_, way_.size() - 1)];
    if (next != map_.find(pose.position)) map_.block(next);
  }

  bool is_frontier(std::size_t i) const { return map_.is_way(i) && !given_up_[i] && map_.borders_unknown(i); }

  // Breadth first over what is known to be free; a frontier under the sky is worth a longer way.
  void plan(const Vec3& from) {
    way_.clear(), step_ = 0, waited_ = 0;
    const VoxelGrid& grid = map_.grid();
    const std::size_t start = map_.find(from);
    std::vector<std::uint32_t> back(grid.count(), kNone), steps(grid.count(), 0);
    std::queue<std::uint32_t> front;
    back[start] = std::uint32_t(start);
    front.push(std::uint32_t(start));
    std::size_t best = grid.count();
    double least = 1e9;
    while (!front.empty()) {
      const std::uint32_t i = front.front();
      front.pop();
      if (steps[i] * kVoxel > least) break;
      if (i != start && is_frontier(i)) {
        const double cost = steps[i] * kVoxel + (map_.has_roof(i) ? 0 : kOpenAir);
        if (cost < least) least = cost, best = i;
      }
      for_each_neighbour(grid, i, [&](std::size_t k) {
        if (back[k] != kNone || !map_.is_way(k)) return;
        back[k] = i, steps[k] = steps[i] + 1;
        front.push(std::uint32_t(k));
      });
    }
    if (best == grid.count()) return;
    for (std::size_t i = best; i != start; i = back[i]) way_.push_back(i);
    std::reverse(way_.begin(), way_.end());
  }

  // At the end of the way it looks at what is unknown beside it, then gives the place up.
  SearchCommand follow(const SearchPose& pose) {
    const VoxelGrid& grid = map_.grid();
    while (step_ < way_.size() && distance(pose.position, grid.centre(way_[step_])) < 0.5 * kVoxel) ++step_;
    if (step_ < way_.size()) return fly_towards(pose, grid.centre(way_[step_]), rules_);
    if (++waited_ > kLookAround) given_up_[way_.back()] = 1;
    SearchCommand command;
    command.turn = rules_.turn_rate;
    return command;
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;

  SearchRules rules_;
  HeatReports heat_;
  ExplorationMap map_;
  DepthMapping add_depth_;
  std::vector<std::uint8_t> given_up_;  // by cell
  std::vector<std::size_t> way_;  // cells
  std::size_t step_ = 0;
  int waited_ = 0, idle_ = 0;
};

}  // namespace

std::unique_ptr<SearchAgent> make_frontier_explorer(const SearchBriefing& briefing) {
  return std::make_unique<Frontier>(briefing, make_ray_mapping(briefing.rules));
}
std::unique_ptr<SearchAgent> make_octomap_explorer(const SearchBriefing& briefing) {
  return std::make_unique<Frontier>(briefing, make_octomap_mapping(briefing.rules));
}

}  // namespace rubble
