// A graphics card, by OpenGL 4.5: or what EGL has in its place, such as a driver that draws on the processor.
#pragma once

#include "render/device/device.h"
#include "render/gl/gl_context.h"

namespace rubble {

class GlDevice : public Device {
 public:
  // Current on the thread that constructs it. Throws RunError as GlContext does.
  explicit GlDevice(const GlContextOptions& options = {});

  const DeviceInfo& info() const override { return info_; }
  DeviceTraffic traffic() const override;
  bool runs_ahead() const override { return true; }
  void make_current() override { context_.make_current(); }
  std::unique_ptr<DeviceScene> load(const PreparedScene& scene, const LightSet& lights,
                                    const LightTable& light, const DeviceSceneOptions& options, ThreadPool& pool) override;

 private:
  GlContext context_;
  DeviceInfo info_;
};

}  // namespace rubble
