// What a real lens does to the light on its way to the sensor, as plain data; formulas: render/optics.
#pragma once

namespace rubble {

// With the defaults the lens is perfect and every picture is as without it. Depth and ground truth are
// always those of the perfect lens. Needs an exposure that is modelled.
struct OpticsSpec {
  // Standard deviation of the core of the point spread function, a Gaussian. Diffraction alone has
  // 0.42 lambda N over the pixel pitch. unit: pixel; range: 0 to 20; 0: none
  double point_spread = 0;
  // Share of the light that surfaces, dust and mounts of the lens scatter over the picture. The veiling
  // glare index of ISO 9358 is this share but for what stays near the source. range: 0 to 0.5
  double glare = 0;
  // Defocus: the distance that is sharp, from the lens along its axis. unit: m; range: 0 to 1e4; 0: all
  // distances are
  double focus_distance = 0;
  double focal_length = 0.004;  // of the aperture focal_length / f_number; unit: m; range: 1e-4 to 2
  // Lateral chromatic aberration: how far red is farther out than blue in the farthest corner; grows
  // with the distance from the axis. unit: pixel; range: -20 to 20
  double lateral_colour = 0;
  double dirt = 0;  // opacity of the smudges on the lens; range: 0 to 1
  int drops = 0;    // of rain on the lens; range: 0 to 500

  bool any() const {
    return point_spread > 0 || glare > 0 || focus_distance > 0 || lateral_colour != 0 || dirt > 0 ||
           drops > 0;
  }
};

}  // namespace rubble
