// LightWatch by the graphics card, see shaders/light_watch.comp.glsl.
#pragma once

#include <vector>

#include "render/colour/light_watch.h"
#include "render/gl/gl_exchange.h"
#include "render/gl/shader.h"

namespace rubble {

class GlLightWatch : public LightWatch {
 public:
  GlLightWatch(const Gl& gl, const WatchedPixels& pixels);

  // radiance: of the image, R, G, B in kcd/m2. In any order. Waits for the card; what comes back are the pixels that report.
  std::vector<LightChange> see(const GlTexture& radiance);

 private:
  const Gl& gl_;
  int pixels_;
  GlProgram program_;
  GlBuffer levels_, thresholds_, count_;
  GlReadback counts_back_, changes_back_;
  bool first_ = true;
};

}  // namespace rubble
