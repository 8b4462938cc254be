// The processor as a device: with code of its own, without any driver, and with the same bits on every machine.
#pragma once

#include "render/device/device.h"

namespace rubble {

class SoftwareDevice : public Device {
 public:
  SoftwareDevice();

  const DeviceInfo& info() const override { return info_; }
  std::unique_ptr<DeviceScene> load(const PreparedScene& scene, const LightSet& lights,
                                    const LightTable& light, const DeviceSceneOptions& options, ThreadPool& pool) override;

 private:
  DeviceInfo info_;
};

}  // namespace rubble
