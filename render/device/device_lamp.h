// The light of the camera's lamp by way of surfaces and fog, where a device finds it itself: what transport/lamp_bounce.h and
// transport/fog_light.h find on the processor.
#pragma once

#include "render/transport/fog_light.h"
#include "render/transport/lamp_reach.h"

namespace rubble {

class DeviceLamp {
 public:
  virtual ~DeviceLamp() = default;

  // For all pictures from now on, in place of what was there. fog: gets that light, too; null: the air is clear, or nobody
  // would see it. Both must stay as they are until the next call.
  virtual void light(const LampReach& reach, const FogLight* fog) = 0;
  virtual void put_out() = 0;
};

}  // namespace rubble
