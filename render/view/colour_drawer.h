// Colours of a view whose surfaces are drawn: shaded by the resolve pass, or path traced. Internal to
// render/.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/media/air_volume.h"
#include "render/colour/colour_pass.h"
#include "render/reference/reference_pass.h"
#include "render/view/lit_scene.h"
#include "render/view/surface_drawer.h"

namespace rubble {

struct ColourImage {
  std::vector<std::uint8_t> rgb;   // 3 bytes a pixel, rows from the top
  float exposure = 0;              // what luminance in kcd/m2 was multiplied by
  PassTime resolve, read, finish;  // as RenderTimes
};

// Colours on their way from the device, or there.
struct StartedColours {
  ColourImage image;                      // what is known of it
  std::unique_ptr<DrawnColours> coming;  // null: all
};

// The same of radiance.
struct StartedRadiance {
  std::vector<float> traced;              // 3 floats a pixel; path traced
  std::unique_ptr<DrawnRadiance> coming;  // null: that is all
};

class ColourDrawer {
 public:
  // The scene must outlive it.
  explicit ColourDrawer(LitScene& scene);

  // After LitScene::change().
  void restart();

  // exposure: as ColourImage's; none: metered on the view itself.
  StartedColours start(const ViewRays& view, DrawnSurfaces& surfaces, std::optional<float> exposure);
  static ColourImage collect(StartedColours started);  // waits for the device
  // Before exposure and tone mapping: 3 floats a pixel; unit: kcd/m2. Without the drops of DropDrawer.
  StartedRadiance start_radiance(const ViewRays& view, DrawnSurfaces& surfaces);
  static std::vector<float> collect(StartedRadiance started);
  // As ColourPass has them. Null: where colours are path traced as well.
  std::unique_ptr<LightWatch> make_light_watch(const WatchedPixels& pixels) const;
  std::vector<LightChange> draw_changes(const ViewRays& view, DrawnSurfaces& surfaces, LightWatch& watch);

 private:
  // What depends on the view: where its lamp is, and the air before it.
  // drops_drawn: as AirVolume::prepare().
  FrameLight light_view(const ViewRays& view, DrawnSurfaces& surfaces, bool drops_drawn);
  FrameLight light_linear(const ViewRays& view, DrawnSurfaces& surfaces);  // for a picture before exposure
  std::vector<float> trace(const ViewRays& view) const;
  void draw_traced(const ViewRays& view, std::optional<float> exposure, ColourImage& image) const;
  void light_shown(DrawnSurfaces& surfaces);             // finds the light of what shows
  void set_bounce(bool shows, DrawnSurfaces& surfaces);  // light of the lamp by way of surfaces
  void start_shaded(const ViewRays& view, DrawnSurfaces& surfaces, std::optional<float> exposure, StartedColours& out);
  float expose(const MeteredImage& metered) const;

  LitScene& scene_;
  AirVolume air_volume_;
  std::unique_ptr<ColourPass> resolve_;        // none: colours are path traced
  std::unique_ptr<ReferencePass> reference_;  // none: colours are the resolve pass's
};

}  // namespace rubble
