// Colours every pixel once, from the triangle that was found there: by the graphics device, or by
// the processor where the device is a software driver, which is slower. The formulas are the same;
// pictures differ by a step of 8 bits here and there.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/camera/projection.h"
#include "render/colour/frame_light.h"
#include "render/geometry/geometry.h"
#include "render/geometry/ground_map.h"
#include "render/lighting/exposure.h"
#include "render/materials/textures.h"
#include "render/passes/glass_layers.h"
#include "render/shading/wide_shader.h"

namespace rubble {

// Which triangle each pixel shows, and how far it is.
struct SurfaceImages {
  const GlTexture* ids;    // as VisibilityPass::ids(); null where the processor shades
  const GlTexture* depth;  // near / Z; null where the processor shades
  const std::vector<float>& depth_values;  // the same
  const std::uint32_t* id_values;          // as ids; null where the device shades
  // Of an image whose pixels have rays of their own, as RayPass has them; null: a pinhole.
  const GlTexture* lens_rays = nullptr;  // null where the processor shades
  const GlTexture* row_poses = nullptr;  // null with lens_rays
  const float* ray_values = nullptr;     // the same: four a pixel
  const float* pose_values = nullptr;    // twelve a row of pixels
  const std::vector<GlassLayer>* behind = nullptr;  // glass; null: as none

  bool through_glass() const { return behind && !behind->empty(); }

  bool has_rays() const { return lens_rays || ray_values; }
};

class ColourPass {
 public:
  virtual ~ColourPass() = default;

  // How bright the view is, for its exposure.
  virtual MeteredImage meter(const ViewProjection& view, const Pose& world_from_camera,
                             const SurfaceImages& surfaces, const FrameLight& light) = 0;
  // Display colours: 4 bytes a pixel, the last unused. exposure: what luminance in kcd/m2 is
  // multiplied by. metered: meter() was the last call, for the same view.
  virtual void draw(const ViewProjection& view, const Pose& world_from_camera,
                    const SurfaceImages& surfaces, const FrameLight& light, float exposure,
                    bool metered) = 0;
  virtual void read(std::vector<std::uint8_t>& rgba) = 0;

  // Radiance before exposure and tone mapping, 4 floats a pixel (R, G, B in kcd/m2).
  virtual std::vector<float> draw_linear(const ViewProjection& view, const Pose& world_from_camera,
                                         const SurfaceImages& surfaces,
                                         const FrameLight& light) = 0;

  static constexpr int kMeterEvery =
      4;  // of pixels in each direction, one is metered; as METER in resolve.frag.glsl
};

// What they refer to must outlive them.
std::unique_ptr<ColourPass> make_gl_colour_pass(const Gl& gl, const GpuGeometry& geometry,
                                                const FrameLight& light, const GroundMap& ground,
                                                const std::vector<PatternImage>& patterns, ThreadPool& pool);
std::unique_ptr<ColourPass> make_processor_colour_pass(const PreparedScene& scene,
                                                       const GpuGeometry& geometry,
                                                       const FrameLight& light,
                                                       const GroundMap& ground,
                                                       const std::vector<PatternImage>& patterns,
                                                       const WideShader& shader, ThreadPool& pool);

}  // namespace rubble
