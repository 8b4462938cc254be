// What stands in a view of a list: its pile, settled once for all views of it, and its camera.
#pragma once

#include <map>
#include <string>

#include "app/assets/asset_library.h"
#include "bench/gallery_list.h"
#include "kernel/model/pile_state.h"
#include "render/camera/view_rays.h"
#include "scripting/mission.h"

namespace rubble {

// Piles that were settled already, by all that a pile follows from.
class GalleryPiles {
 public:
  const PileState& of(const GalleryPicture& picture, const Scenario& scenario,
                      const AssetLibrary& assets, int threads);

 private:
  std::map<std::string, PileState> piles_;
};

// A square image of `size` pixels from where the mission's flight begins.
ViewRays view_of(const Scenario& scenario, int size);

}  // namespace rubble
