#include "app/support/drawing_device.h"

#include <cstdlib>
#include <string>

#include "kernel/base/error.h"

namespace rubble {

DeviceKind asked_device(int gl_device) {
  if (gl_device >= 0) return DeviceKind::gl;
  const char* const text = std::getenv("RUBBLE_DEVICE");
  const std::string found = text ? text : "";
  if (found.empty() || found == "software") return DeviceKind::software;
  if (found == "gl") return DeviceKind::gl;
  throw InputError({"", 0, "RUBBLE_DEVICE", "is no device", "software or gl", found, "set it to one of them, or unset it"});
}

std::unique_ptr<Device> open_device(int gl_device, int threads) {
  return make_device({asked_device(gl_device), gl_device, threads});
}

}  // namespace rubble
