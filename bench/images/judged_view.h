// A view in which another renderer can mean the same as ours: plain surfaces, clear air, one sun and the
// camera's lamp. Traced by our path tracer, and written for the other one.
#pragma once

#include <string>

#include "app/assets/asset_library.h"
#include "bench/images/plain_surfaces.h"
#include "kernel/model/pile_state.h"
#include "render/lighting/lighting.h"
#include "render/reference/traced_image.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct JudgeOptions {
  int size = 256;     // of the square image; unit: pixel
  int samples = 256;  // paths a pixel
  int threads = 1;    // the image does not depend on it
  double colour = 2;  // of strengthen_colours()
  double mirror = 0;  // roughness of PlainSurfaces as mirrors; 0: matt
};

class JudgedView {
 public:
  // Throws RunError for what the renderers do not share: fog, other lights, a lens that is no pinhole. The
  // assets must outlive it.
  JudgedView(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
             const JudgeOptions& options);

  // Throws RunError when the image shows the sky or what is farther than 12 m: there the path tracer adds a
  // skyline and the veil of clean air.
  TracedImage trace() const;
  // FOLDER/NAME.glb, NAME_sky.exr, NAME_ours.pfm (radiance; unit: kcd/m2) and NAME.json, which says how they
  // belong together. seconds: that trace() took.
  void write(const std::string& folder, const std::string& name, const TracedImage& image,
             double seconds) const;

  const PileModel& model() const { return model_; }

 private:
  JudgeOptions options_;
  PileModel model_;
  PreparedScene scene_;
  LightSet lights_;
  TracedView view_;
};

// Rows of a colour image from the top, as a portable float map.
std::string encode_pfm(int width, int height, const std::vector<Vec3f>& values);

}  // namespace rubble
