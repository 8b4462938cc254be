// All that a renderer draws views with. Internal to render/.
#pragma once

#include "render/passes/ground_truth.h"
#include "render/view/colour_drawer.h"
#include "render/view/drop_drawer.h"
#include "render/view/lit_scene.h"
#include "render/view/surface_drawer.h"

namespace rubble {

struct ViewSource {
  ViewSource(Device& device, const Scene& s, const RenderOptions& options,
             const std::function<void(double)>& progress)
      : scene(device, s, options, progress),
        surfaces(scene),
        colours(scene),
        drops(scene),
        truth(scene.scene, scene.on_device->names(), scene.rays, options.threads) {}

  LitScene scene;          // as prepared by the renderer
  SurfaceDrawer surfaces;  // of that scene
  ColourDrawer colours;    // of that scene
  DropDrawer drops;        // of that scene
  GroundTruthMaker truth;  // of that scene
};

}  // namespace rubble
