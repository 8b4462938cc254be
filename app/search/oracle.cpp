// The upper bound: it knows the pile and where everybody lies, and flies from one to the next nearest.
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/search/baselines.h"
#include "kernel/voids/void_path.h"

namespace rubble {
namespace {

constexpr double kArrived = 0.02;  // at a corner of the way; unit: m
constexpr int kPatience = 10;      // stopped steps before a corner is left out

class Oracle : public SearchAgent {
 public:
  Oracle(const SearchBriefing& briefing, const SearchWorld& world)
      : rules_(briefing.rules), world_(world), found_(world.targets().size(), 0) {}

  SearchAction act(const SearchObservation& seen) override {
    SearchAction action;
    if (target_ < 0) choose(seen.pose.position);
    if (target_ < 0) {
      action.done = true;
      return action;
    }
    patience_ = seen.stopped ? patience_ - 1 : kPatience;
    while (next_ < way_.size() && (distance(seen.pose.position, way_[next_]) < kArrived || patience_ <= 0)) {
      ++next_;
      patience_ = kPatience;
    }
    if (next_ < way_.size()) {
      action.command = fly_towards(seen.pose, way_[next_], rules_);
      return action;
    }
    action.reports = {world_.targets()[std::size_t(target_)].victim.trunk};
    found_[std::size_t(target_)] = 1;
    target_ = -1;
    return action;
  }

 private:
  // The nearest by the way through the voids.
  void choose(const Vec3& from) {
    const VoidSpace& space = world_.voids().space;
    const NearestPlace here = find_nearest_place(space, from, rules_.radius, 3 * space.grid.voxel);
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (found_[i] || !std::isfinite(world_.targets()[i].shortest)) continue;
      const FoundPath path = find_path(space, here.position, world_.targets()[i].lookout, rules_.radius);
      if (!path.found || path.length >= shortest) continue;
      shortest = path.length, target_ = int(i), way_ = path.points;
    }
    next_ = 0, patience_ = kPatience;
  }

  SearchRules rules_;
  const SearchWorld& world_;
  std::vector<std::uint8_t> found_;
  int target_ = -1;        // it is on its way to; -1: none
  std::vector<Vec3> way_;  // corners; unit: m
  std::size_t next_ = 0;
  int patience_ = kPatience;
};

}  // namespace

std::unique_ptr<SearchAgent> make_oracle(const SearchBriefing& briefing, const SearchWorld& world) {
  return std::make_unique<Oracle>(briefing, world);
}

}  // namespace rubble
