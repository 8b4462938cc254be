// Exposure of the display image: metered on the frame itself, so that every frame is well exposed and
// is the same whichever frames were drawn before it.
#pragma once

#include <vector>

namespace rubble {

struct ExposureOptions {
  double key = 0.16;  // exposed luminance that the metered mean is brought to, in daylight
  // Fixed factor on luminance in kcd/m2; 0: automatic.
  double fixed = 0;
  // Share of the key that is left at very low light: dusk looks darker than noon, as to the eye; 1:
  // all. After Krawczyk, Myszkowski and Seidel, "Perceptual Effects in Real-time Tone Mapping" (2005).
  double dusk = 0.35;
};

// Of images for display.
inline constexpr ExposureOptions kDisplayExposure{0.21};

// Every 4th pixel of an image in each direction, rows in any order.
struct MeteredImage {
  int width = 0, height = 0;  // of what was metered: a quarter of the image's
  std::vector<float> stops;   // log2 of luminance in kcd/m2; below -1000: nothing is seen there
};

// What luminance in kcd/m2 is to be multiplied by. The mean of the logarithm counts, the middle
// doubly. Where nothing is seen: 0.1.
float find_exposure(const ExposureOptions& options, const MeteredImage& image);

}  // namespace rubble
