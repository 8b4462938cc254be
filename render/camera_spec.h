// What a camera measures, as plain data: the part of a mission that render/sensors carries out.
#pragma once

namespace rubble {

// Ground truth beside colour and depth; each costs nothing where it is not asked for.
struct ChannelSet {
  bool normals = false;
  bool instance = false;
  bool label = false;
  bool flow = false;
  bool sky_visibility = false;  // 64 rays a pixel: about 15 s for a million pixels on two cores

  bool any() const { return normals || instance || label || flow || sky_visibility; }
};

}  // namespace rubble
