#include "render/devices/gl/gl_device.h"

#include "render/devices/gl/gl_colour_pass.h"
#include "render/devices/gl/gl_raster.h"
#include "render/devices/gl/gl_shadow_pass.h"
#include "render/devices/gl/lamp_pass.h"
#include "render/gl/gl.h"

namespace rubble {

namespace {

class GlScene : public DeviceScene {
 public:
  GlScene(GlContext& context, const PreparedScene& scene, const LightSet& lights, const LightTable& light,
          const DeviceSceneOptions& options)
      : context_(context),
        scene_(scene),
        geometry_(context.gl(), scene, make_scene_tables(scene), light),
        raster_(context.gl(), scene, geometry_) {
    if (options.shades)
      shadows_ = std::make_unique<GlShadowPass>(context.gl(), scene, geometry_, lights, options.shadow_side);
  }

  const TriangleNames& names() const override { return geometry_.tables.names; }
  TriangleRaster& raster() override { return raster_; }
  const ShadowViews& shadows() const override { return shadows_->views(); }
  void move() override {
    geometry_.place(scene_);
    if (shadows_) shadows_->move();
  }
  void set_light(const LightTable& light, const std::vector<LightRange>* changed) override {
    geometry_.set_light(light, changed);
  }
  DeviceLamp* lamp(const BakeLinks& links, const std::vector<std::uint32_t>& first_point) override {
    if (!lamp_) lamp_ = std::make_unique<LampPass>(context_.gl(), scene_, geometry_, links, first_point);
    return lamp_.get();
  }
  std::unique_ptr<ColourPass> make_colour_pass(const FrameLight& light, const GroundMap& ground,
                                               const std::vector<PatternImage>& patterns) override {
    return std::make_unique<GlColourPass>(context_.gl(), geometry_, raster_, *shadows_, lamp_, light, ground, patterns);
  }

 private:
  GlContext& context_;
  const PreparedScene& scene_;
  GlGeometry geometry_;
  GlRaster raster_;
  std::unique_ptr<GlShadowPass> shadows_;  // null: colours are not asked for
  std::unique_ptr<LampPass> lamp_;         // null: no lamp was lit
};

}  // namespace

GlDevice::GlDevice(const GlContextOptions& options) : context_(options) {
  const GlInfo& gl = context_.info();
  info_.name = "gl";
  info_.about = gl.renderer;
  info_.details = {{"gl_renderer", gl.renderer},
                   {"gl_version", gl.version + " (" + gl.vendor + ")"},
                   {"egl_device", gl.egl_device + ": " + gl.why},
                   {"egl_version", gl.egl_version}};
  info_.limits = gl.limits;
}

DeviceTraffic GlDevice::traffic() const {
  const GlTraffic& t = context_.traffic();
  return {t.given, t.taken, t.waits};
}

std::unique_ptr<DeviceScene> GlDevice::load(const PreparedScene& scene, const LightSet& lights,
                                            const LightTable& light, const DeviceSceneOptions& options,
                                            ThreadPool&) {
  return std::make_unique<GlScene>(context_, scene, lights, light, options);
}

}  // namespace rubble
