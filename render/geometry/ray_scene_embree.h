// What RayScene holds of Embree. Internal to its sources.
#pragma once

#include <embree3/rtcore.h>

#include "render/geometry/ray_scene.h"

namespace rubble {

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

}  // namespace rubble
