#include "bench/images/gallery_piles.h"

#include "app/scene/build_scene.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

const PileState& GalleryPiles::of(const GalleryPicture& picture, const Scenario& scenario,
                                  const AssetLibrary& assets, int threads) {
  std::string key = picture.mission;
  for (const std::string& change : picture.set)
    if (change.rfind("pile.", 0) == 0 || change.rfind("seed", 0) == 0) key += "\n" + change;
  const auto found = piles_.find(key);
  if (found != piles_.end()) return found->second;
  SettleOptions options = scenario.settle;
  options.threads = threads;
  return piles_[key] = settle_pile(generate_pile(build_pile_spec(scenario.pile, scenario.seed, assets)), options);
}

ViewRays view_of(const Scenario& scenario, int size) {
  const CameraPose pose = sample_trajectory(scenario.trajectory, scenario.start_ns).front();
  CameraScenario sized = scenario.cameras.front().camera;
  sized.width = sized.height = size;
  return {pose.stamp_ns, sized.intrinsics(), pose.world_from_camera};
}

}  // namespace rubble
