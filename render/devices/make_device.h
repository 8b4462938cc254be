// The devices that there are. Nothing else names them.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/device/device.h"
#include "render/scene/device_kind.h"

namespace rubble {

struct DeviceChoice {
  DeviceKind kind = DeviceKind::software;
  int gl_device = -1;  // as GlContextOptions
  int threads = 0;     // of a graphics driver that draws on the processor; 0: its own choice
};
// Throws RunError as GlContext does, for `gl`. `software` opens no driver.
std::unique_ptr<Device> make_device(const DeviceChoice& choice);

// The device file of a graphics card of this machine; "": none is seen. Opens no driver.
std::string find_card();

// What each way to a graphics card gives, for `rubble info --gl`.
struct CardReport {
  std::vector<std::pair<std::string, std::string>> ways;  // in the order in which they are tried: name and outcome
  std::vector<std::string> circumstances;                 // what on this machine decides how they fare
};
// Opens each once. Throws RunError where libEGL itself is missing.
CardReport report_cards();

}  // namespace rubble
