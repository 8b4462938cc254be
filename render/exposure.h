// Automatic exposure: metered on the image that was drawn, followed with a lag. Depends only on
// the frames before it, so a sequence is the same each time it is drawn.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

struct ExposureOptions {
  double key = 0.16;      // exposed luminance that the metered mean is brought to, in daylight
  double seconds = 0.25;  // time constant of the lag; unit: s
  // Fixed factor on luminance in kcd/m2; 0: automatic.
  double fixed = 0;
  // Share of the key that is left at very low light: dusk looks darker than noon, as to the eye; 1:
  // all. After Krawczyk, Myszkowski and Seidel, "Perceptual Effects in Real-time Tone Mapping" (2005).
  double dusk = 0.35;
};

class AutoExposure {
 public:
  explicit AutoExposure(const ExposureOptions& options) : options_(options) {}

  float factor() const { return factor_; }
  void restart() { settled_ = false; }  // the next frame is metered like a first one
  bool settled() const { return settled_; }
  // Meters a drawn image (alpha as in shaders/tone.glsl). The first frames jump to the metered
  // value until it holds; later ones approach it over `elapsed` seconds.
  void follow(const std::vector<std::uint8_t>& rgba, int width, int height, double elapsed);

 private:
  ExposureOptions options_;
  float factor_ = 0.1f;
  bool settled_ = false;
};

}  // namespace rubble
