// Which pixels of an event camera have seen their light change, where a device finds them itself: what
// sensors/event_camera.h finds from images on the processor.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

// Levels are ln(luminance + dark), luminance in cd/m2.
struct WatchedPixels {
  int width = 0, height = 0;     // unit: pixel
  std::vector<float> up, down;  // one a pixel, rows from the top: change of the level by which it reports, above 0
  float dark = 0;                // unit: cd/m2
};

// A pixel that reports.
struct LightChange {
  std::uint32_t pixel;
  float from, to;   // level in the image before and in this one
  float reference;  // of its last report before this image
};

// What a device remembers of the images before. The first one only sets the levels.
class LightWatch {
 public:
  virtual ~LightWatch() = default;
};

}  // namespace rubble
