#include "render/devices/software/software_device.h"

#include "render/devices/software/shadow_map.h"
#include "render/devices/software/software_colour_pass.h"
#include "render/devices/software/software_raster.h"

namespace rubble {

namespace {

class SoftwareScene : public DeviceScene {
 public:
  SoftwareScene(const PreparedScene& scene, const LightSet& lights, const DeviceSceneOptions& options, ThreadPool& pool)
      : scene_(scene),
        shader_(find_wide_shader(options.instruction_set)),
        pool_(pool),
        tables_(make_scene_tables(scene)),
        shapes_(scene.meshes.size()),
        raster_(scene, shapes_, tables_.names, pool_) {
    decltype(tables_.indices)().swap(tables_.indices);  // frees it; "= {}" would keep its memory
    for (std::size_t i = 0; i < shapes_.size(); ++i) shapes_[i] = make_cluster_shapes(scene.meshes[i]);
    if (options.shades)
      shadows_ = std::make_unique<SoftwareShadowMap>(scene, lights, shapes_, options.shadow_side, pool_);
  }

  const TriangleNames& names() const override { return tables_.names; }
  TriangleRaster& raster() override { return raster_; }
  const ShadowViews& shadows() const override { return shadows_->views(); }
  void move() override {
    tables_.place(scene_);
    if (shadows_) shadows_->move();
  }
  // It is read where it lies, by FrameLight::nodes.
  void set_light(const LightTable&, const std::vector<LightRange>*) override {}
  std::unique_ptr<ColourPass> make_colour_pass(const FrameLight& light, const GroundMap& ground,
                                               const std::vector<PatternImage>& patterns) override {
    return make_software_colour_pass(scene_, tables_, *shadows_, light, ground, patterns, shader_, pool_);
  }

 private:
  const PreparedScene& scene_;
  const WideShader& shader_;
  ThreadPool& pool_;
  SceneTables tables_;
  std::vector<ClusterShapes> shapes_;  // one a mesh
  SoftwareRaster raster_;
  std::unique_ptr<SoftwareShadowMap> shadows_;  // null: colours are not asked for
};

}  // namespace

SoftwareDevice::SoftwareDevice() {
  info_.name = "software";
  info_.about = std::string("the processor, by ") + find_wide_shader("").name;
}

std::unique_ptr<DeviceScene> SoftwareDevice::load(const PreparedScene& scene, const LightSet& lights,
                                                  const LightTable&, const DeviceSceneOptions& options,
                                                  ThreadPool& pool) {
  return std::make_unique<SoftwareScene>(scene, lights, options, pool);
}

}  // namespace rubble
