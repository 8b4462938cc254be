// The voids of a pile as it lies now, mapped by a thread of its own while the drive goes on, and shown as points.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/drive/overlay/overlay.h"
#include "kernel/voids/void_map.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class VoidSurvey {
 public:
  // Of the mission's `voids`: voxel and the robot's radius. The library must outlive it.
  VoidSurvey(const VoidScenario& voids, const AssetLibrary& assets);
  ~VoidSurvey();  // stops what is under way
  VoidSurvey(const VoidSurvey&) = delete;
  VoidSurvey& operator=(const VoidSurvey&) = delete;

  // Maps the voids of that pile: the map before is forgotten. step: of the world, for label().
  void start(const PileState& pile, std::int64_t step, int threads);
  void forget();  // stops what is under way

  bool working() const { return thread_.joinable() && !done_; }
  // The map, when it is complete. Throws, once, what the mapping threw.
  const VoidMap* map();
  bool take_news();  // whether the map became complete since the last call
  double progress() const { return progress_; }  // 0 to 1
  PictureLabel label() const;  // what the points mean, or how far the map is

 private:
  VoidScenario voids_;
  const AssetLibrary& assets_;
  std::int64_t step_ = 0;
  bool told_ = true;
  std::thread thread_;
  std::atomic<bool> stop_{false}, done_{false};
  std::atomic<double> progress_{0};
  std::unique_ptr<VoidMap> map_;     // of the thread until it is done
  std::exception_ptr failure_;       // likewise
};

// Places where the centre of the robot fits, as small crosses by their clearance: from red, where it just fits, by yellow
// and green to blue, where three times its radius is free; and the entrances as white arrows inwards. The map is of one
// radius. At most some thousands are shown, evenly chosen.
void add_voids(const VoidMap& map, std::vector<OverlayLine>& lines);

}  // namespace rubble
