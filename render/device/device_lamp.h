// The light of the camera's lamp by way of surfaces and fog, where a device finds it itself: what transport/lamp_bounce.h
// and transport/fog_light.h find on the processor.
#pragma once

#include <cstdint>
#include <vector>

#include "render/media/air_links.h"

namespace rubble {

// A lamp and what it may light. What it refers to must stay as it is as long as the lamp is lit.
struct LampAim {
  Vec3f position, axis;  // in the world; the way it looks, unit length
  Vec3f intensity;       // on the axis; unit: kcd
  float cone = 1;        // 1 / (1 - cosine of the half-power angle)
  float extinction = 0;  // of the air about it; unit: 1/m
  const std::vector<float>* map = nullptr;           // as LampReach has it
  const std::vector<std::uint32_t>* seen = nullptr;  // likewise
  int map_side = 0;
  float reach = 0, fade = 0, near = 0, slack = 0;  // as in LampReach
};

// The air that scatters its light.
struct LampAir {
  const AirLinks* links = nullptr;
  const AirMatter* matter = nullptr;
  std::uint64_t matter_version = 0;  // another number for other matter
  float off = 0;                     // from surfaces, where the air's light is asked for; unit: m
  float tolerance = 0;               // change of all light by which its iteration ends
  int most_iterations = 0;
};

class DeviceLamp {
 public:
  virtual ~DeviceLamp() = default;

  // For all pictures from now on, in place of what was there. air: gets that light, too; null: it is clear, or nobody
  // would see it.
  virtual void light(const LampAim& aim, const LampAir* air) = 0;
  virtual void put_out() = 0;
};

}  // namespace rubble
