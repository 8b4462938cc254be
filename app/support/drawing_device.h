// Which device draws: by --device, else by $RUBBLE_DEVICE, else by the key `device` of the mission. What is made again from a
// manifest is drawn by the device of the manifest.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/devices/make_device.h"

namespace rubble {

// "software", "gl", or "gl:N".
struct AskedDevice {
  DeviceKind kind = DeviceKind::software;
  int card = -1;  // its number in `rubble info --gl`; -1: the first that works
};

// Nothing: there is no such device.
std::optional<AskedDevice> read_device(const std::string& text);
// What read_device() takes, for messages.
std::string describe_devices();

// option: --device, which read_device() takes; "": not given. Nothing: neither it nor $RUBBLE_DEVICE says. Throws InputError
// where the variable names no device.
std::optional<AskedDevice> asked_device(const std::string& option);

// For what has no mission: `software` where nobody asks. Throws RunError as make_device() does.
std::unique_ptr<Device> open_device(const std::string& option, int threads);
// kind: the mission's. The option or the variable may choose a card. Throws InputError where the option names another kind
// of device than this.
std::unique_ptr<Device> open_device(DeviceKind kind, const std::string& option, int threads);

}  // namespace rubble
