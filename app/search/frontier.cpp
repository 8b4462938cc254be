// Frontier exploration (Yamauchi 1997) in three dimensions: to the nearest place that is known to be free and
// borders on what is not known, on a map of cells that it makes from its depth pictures.
#include <algorithm>
#include <cmath>
#include <queue>

#include "app/search/baselines.h"
#include "app/search/heat_reports.h"
#include "kernel/base/portable_math.h"
#include "kernel/voids/voxel_grid.h"

namespace rubble {
namespace {

constexpr double kVoxel = 0.1;     // unit: m
constexpr double kAround = 0.5;    // the pile is mapped, too; unit: m
constexpr double kMapped = 5;      // of a ray; unit: m
constexpr int kStride = 2;         // of the pixels that are mapped, each way
constexpr double kOpenAir = 3;     // how much farther a place under the sky seems; unit: m
constexpr int kLookAround = 40;    // steps at a frontier before it is given up
enum State : std::uint8_t { kUnknown, kFree, kSolid };

class Frontier : public SearchAgent {
 public:
  explicit Frontier(const SearchBriefing& briefing)
      : rules_(briefing.rules), heat_(briefing), rays_(search_camera(briefing.rules), briefing.rules.max_range) {
    grid_.voxel = kVoxel;
    grid_.corner = briefing.bounds.min - Vec3{kAround, kAround, 0};
    grid_.corner.z = 0;
    const Vec3 size = briefing.bounds.max - grid_.corner + Vec3{kAround, kAround, kAround};
    for (int k = 0; k < 3; ++k) grid_.size[std::size_t(k)] = std::max(1, int(std::ceil(size[k] / kVoxel)));
    state_.assign(grid_.count(), kUnknown);
    near_solid_.assign(grid_.count(), 0);
    given_up_.assign(grid_.count(), 0);
    // Too near to the ground, which is outside of the grid.
    for (std::size_t i = 0; i < near_solid_.size(); ++i) near_solid_[i] = grid_.centre(i).z < rules_.radius + 0.5 * kVoxel;
  }

  SearchAction act(const SearchObservation& seen) override {
    SearchAction action;
    action.reports = heat_.update(seen);
    map(seen);
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
  void map(const SearchObservation& seen) {
    const Pose body = seen.pose.world_from_body();
    mark_body(seen.pose.position);
    for (int v = 0; v < rules_.height; v += kStride)
      for (int u = 0; u < rules_.width; u += kStride) {
        const auto pixel = std::size_t(v) * std::size_t(rules_.width) + std::size_t(u);
        const double range = double(seen.depth[pixel]) / rays_.cosine(pixel);
        mark_ray(body.translation, body.rotation.rotate(rays_.direction(pixel)), range);
      }
  }

  void mark_body(const Vec3& at) {
    const int reach = int(rules_.radius / kVoxel) + 1;
    const Cell middle = grid_.find_cell(at);
    for_each_within(middle, reach, [&](std::size_t i) {
      if (distance(grid_.centre(i), at) < rules_.radius && state_[i] == kUnknown) state_[i] = kFree;
    });
  }

  void mark_ray(const Vec3& from, const Vec3& along, double range) {
    const double end = std::min(range - 0.5 * kVoxel, kMapped);
    for (double d = 0.25 * kVoxel; d < end; d += 0.5 * kVoxel) {
      const Cell cell = grid_.find_cell(from + along * d);
      if (!grid_.contains(cell)) continue;
      std::uint8_t& state = state_[grid_.index(cell)];
      if (state == kUnknown) state = kFree;
    }
    if (range > kMapped) return;
    const Cell hit = grid_.find_cell(from + along * (range + 1e-3));
    if (grid_.contains(hit)) set_solid(hit);
  }

  void set_solid(const Cell& cell) {
    std::uint8_t& state = state_[grid_.index(cell)];
    if (state == kSolid) return;
    state = kSolid;
    for_each_within(cell, 2, [&](std::size_t i) {
      if (distance(grid_.centre(i), grid_.centre(cell)) < rules_.radius + 0.5 * kVoxel) near_solid_[i] = 1;
    });
  }

  // What cannot be seen so near: the place where it was stopped.
  void block_ahead(const SearchPose& pose) {
    if (way_.empty()) return;
    given_up_[way_.back()] = 1;
    const std::size_t next = way_[std::min(step_, way_.size() - 1)];
    if (next != grid_.index(clamp(grid_.find_cell(pose.position)))) near_solid_[next] = 1;
  }

  template <typename Visit>
  void for_each_within(const Cell& c, int reach, const Visit& visit) const {
    for (int z = c[2] - reach; z <= c[2] + reach; ++z)
      for (int y = c[1] - reach; y <= c[1] + reach; ++y)
        for (int x = c[0] - reach; x <= c[0] + reach; ++x)
          if (grid_.contains({x, y, z})) visit(grid_.index({x, y, z}));
  }

  Cell clamp(Cell c) const {
    for (std::size_t k = 0; k < 3; ++k) c[k] = std::clamp(c[k], 0, grid_.size[k] - 1);
    return c;
  }

  bool is_way(std::size_t i) const { return state_[i] == kFree && !near_solid_[i]; }
  bool is_frontier(std::size_t i) const {
    if (!is_way(i) || given_up_[i]) return false;
    bool borders = false;
    for_each_neighbour(grid_, i, [&](std::size_t k) { borders = borders || state_[k] == kUnknown; });
    return borders;
  }
  bool has_roof(std::size_t i) const {
    const std::size_t layer = std::size_t(grid_.size[0]) * std::size_t(grid_.size[1]);
    for (std::size_t k = i; k < state_.size(); k += layer)
      if (state_[k] == kSolid) return true;
    return false;
  }

  // Breadth first over what is known to be free; a frontier under the sky is worth a longer way.
  void plan(const Vec3& from) {
    way_.clear(), step_ = 0, waited_ = 0;
    const std::size_t start = grid_.index(clamp(grid_.find_cell(from)));
    std::vector<std::uint32_t> back(grid_.count(), kNone), steps(grid_.count(), 0);
    std::queue<std::uint32_t> front;
    back[start] = std::uint32_t(start);
    front.push(std::uint32_t(start));
    std::size_t best = grid_.count();
    double least = 1e9;
    while (!front.empty()) {
      const std::uint32_t i = front.front();
      front.pop();
      if (steps[i] * kVoxel > least) break;
      if (i != start && is_frontier(i)) {
        const double cost = steps[i] * kVoxel + (has_roof(i) ? 0 : kOpenAir);
        if (cost < least) least = cost, best = i;
      }
      for_each_neighbour(grid_, i, [&](std::size_t k) {
        if (back[k] != kNone || !is_way(k)) return;
        back[k] = i, steps[k] = steps[i] + 1;
        front.push(std::uint32_t(k));
      });
    }
    if (best == grid_.count()) return;
    for (std::size_t i = best; i != start; i = back[i]) way_.push_back(i);
    std::reverse(way_.begin(), way_.end());
  }

  // At the end of the way it looks at what is unknown beside it, then gives the place up.
  SearchCommand follow(const SearchPose& pose) {
    while (step_ < way_.size() && distance(pose.position, grid_.centre(way_[step_])) < 0.5 * kVoxel) ++step_;
    if (step_ < way_.size()) return fly_towards(pose, grid_.centre(way_[step_]), rules_);
    if (++waited_ > kLookAround) given_up_[way_.back()] = 1;
    SearchCommand command;
    command.turn = rules_.turn_rate;
    return command;
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;

  SearchRules rules_;
  HeatReports heat_;
  DepthRays rays_;
  VoxelGrid grid_;
  std::vector<std::uint8_t> state_, near_solid_, given_up_;
  std::vector<std::size_t> way_;  // cells
  std::size_t step_ = 0;
  int waited_ = 0, idle_ = 0;
};

}  // namespace

std::unique_ptr<SearchAgent> make_frontier_explorer(const SearchBriefing& briefing) {
  return std::make_unique<Frontier>(briefing);
}

}  // namespace rubble
