// How a renderer draws, and what that took.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "render/scene/camera_spec.h"

namespace rubble {

struct RenderOptions {
  // Where textures and baked light are kept from run to run, see DiskCache; "": nowhere.
  std::string cache_folder;
  int threads = 1;         // for preparing and baking; the result does not depend on it
  bool bake = true;        // light by way of the sky and other surfaces; false: open sky everywhere
  int bake_rays = 512;     // a bake point at most; range: 8 to 1024
  int shadow_size = 4096;  // side of the main light's shadow map; unit: texel
  int texture_size = 512;  // side of the procedural textures; a power of two
  // Of the shading by the software device, as WideShader::name: all give the same bits; "": the fastest that it can run.
  std::string instruction_set;
  bool occlusion_culling = true;  // false: draws all that is in the view; the image is the same
  double coarse_below = 0;    // allow coarser levels for triangles about this small; unit: pixel;
                              // 0: the finest always, so that depth is that of the true surface
  bool antialias = true;      // smooth silhouettes of the colour image
  double fixed_exposure = 0;  // factor on luminance in kcd/m2; 0: automatic
  ColourSpec colour;          // fast, or path traced
  // Of a path-traced image: called on the calling thread with its done fraction; may throw to stop.
  std::function<void(double)> image_progress;
};

// What a pass took. Where other programs share the processors only the processor time means
// something.
struct PassTime {
  double elapsed = 0;    // unit: ms
  double processor = 0;  // of all threads of this program; unit: ms
};

// What the channels of one view took so far; 0: not made yet.
struct RenderTimes {
  PassTime visibility;  // which triangle each pixel shows
  PassTime resolve;     // colours
  PassTime read;        // the image back from the device, which may have to draw it first
  PassTime finish;      // smooth edges
  std::size_t triangles = 0;  // drawn
};

}  // namespace rubble
