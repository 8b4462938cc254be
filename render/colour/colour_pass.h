// Colours every pixel once, from the triangle that was found there. The formulas are the same on every device; pictures
// differ by a step of 8 bits here and there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera/projection.h"
#include "render/colour/frame_light.h"
#include "render/colour/light_watch.h"
#include "render/lighting/exposure.h"
#include "render/passes/glass_layers.h"

namespace rubble {

// Which triangle each pixel shows, and how far it is.
struct SurfaceImages {
  // As TriangleRaster has them: near / Z. Null with in_raster alone.
  const std::uint32_t* ids;
  const std::vector<float>* depth_values;
  bool in_raster = false;  // both lie in the raster of the device, too
  // Of an image whose pixels have rays of their own, as RayPass has them; null: a pinhole.
  const float* ray_values = nullptr;   // four a pixel
  const float* pose_values = nullptr;  // twelve a row of pixels
  std::uint64_t lens = 0;              // another number whenever ray_values are others
  const std::vector<GlassLayer>* behind = nullptr;  // glass; null: as none

  bool through_glass() const { return behind && !behind->empty(); }
  bool has_rays() const { return ray_values; }
};

// Display colours that a device draws, or has drawn. The pass must outlive them; it may draw others meanwhile.
class DrawnColours {
 public:
  virtual ~DrawnColours() = default;
  // 3 bytes a pixel, once. Returns the exposure that they were drawn with.
  virtual float take(std::vector<std::uint8_t>& rgb) = 0;
};

// Likewise, before exposure and tone mapping.
class DrawnRadiance {
 public:
  virtual ~DrawnRadiance() = default;
  // 4 floats a pixel (R, G, B in kcd/m2), once.
  virtual std::vector<float> take() = 0;
};

class ColourPass {
 public:
  virtual ~ColourPass() = default;

  // The exposure that the view asks for: what luminance in kcd/m2 is multiplied by.
  virtual float meter(const ViewProjection& view, const Pose& world_from_camera,
                      const SurfaceImages& surfaces, const FrameLight& light) = 0;
  // Display colours. exposure: none: as meter() finds it.
  // metered: meter() was the last call, for the same view.
  virtual void draw(const ViewProjection& view, const Pose& world_from_camera,
                    const SurfaceImages& surfaces, const FrameLight& light, std::optional<float> exposure,
                    bool metered) = 0;
  // What was drawn; a device starts now. smooth: with smooth edges (passes/antialias.h).
  virtual std::unique_ptr<DrawnColours> finish(const SurfaceImages& surfaces, bool smooth) = 0;

  virtual std::unique_ptr<DrawnRadiance> draw_linear(const ViewProjection& view, const Pose& world_from_camera,
                                                     const SurfaceImages& surfaces, const FrameLight& light) = 0;

  // For what an event camera sees. Null: this device does not find it; draw_linear() has the light.
  virtual std::unique_ptr<LightWatch> make_light_watch(const WatchedPixels& pixels) { return (void)pixels, nullptr; }
  // The pixels whose light has changed since the image that this watch saw before. watch: made by a pass of the device.
  virtual std::vector<LightChange> draw_changes(const ViewProjection& view, const Pose& world_from_camera,
                                                const SurfaceImages& surfaces, const FrameLight& light, LightWatch& watch) {
    return (void)view, (void)world_from_camera, (void)surfaces, (void)light, (void)watch, std::vector<LightChange>();
  }

  static constexpr int kMeterEvery =
      4;  // of pixels in each direction, one is metered; as METER in resolve.frag.glsl
};

}  // namespace rubble
