// Colours of the reference renderer: a view's light by path tracing, in place of ResolvePass.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/geometry/ground_map.h"
#include "render/lighting/lighting.h"
#include "render/materials/textures.h"
#include "render/media/medium.h"
#include "render/reference/traced_image.h"

namespace rubble {

struct ReferenceOptions {
  int samples = 64;        // a pixel; range: 1 to 65536
  bool denoise = false;    // filtered, see denoise.h
  bool jitter = true;      // smooth edges; false: each pixel's middle alone
  int threads = 1;         // the result does not depend on it
  std::uint64_t seed = 0;  // of all random numbers of the paths
  // Where finished images are kept, and the tiles of unfinished ones: a frame that was interrupted
  // goes on where it was. As DiskCache; "": nowhere.
  std::string cache_folder;
  // Called on the calling thread with the done fraction of an image; may throw to stop.
  std::function<void(double)> progress;
};

struct ReferenceSurroundings {
  const PreparedScene& scene;                 // must outlive the pass
  const LightSet& lights;                     // of the place
  const std::vector<PatternImage>& patterns;  // by Pattern
  const GroundMap& ground;                    // of debris on the ground
  double wetness = 0;                         // as Scene::wetness
};

class ReferencePass {
 public:
  ReferencePass(const ReferenceSurroundings& surroundings, const ReferenceOptions& options);
  ~ReferencePass();

  // Radiance, 3 floats a pixel (kcd/m2); black where the lens sees nothing. The lamp and the air are
  // those of the view's instant, and so must be the scene.
  std::vector<float> draw(const ViewRays& view, const LampSpec& lamp, const Air& air);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
