// Which device draws, by what a person asked for.
#pragma once

#include <memory>

#include "render/devices/make_device.h"

namespace rubble {

// gl_device: --gl-device; at 0 or above, that card draws. Otherwise $RUBBLE_DEVICE says what draws, `software` or `gl`;
// software where it is not set. Throws InputError for another word, RunError as make_device() does.
DeviceKind asked_device(int gl_device);
std::unique_ptr<Device> open_device(int gl_device, int threads);

}  // namespace rubble
