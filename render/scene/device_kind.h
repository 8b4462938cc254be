// What draws a mission.
#pragma once

#include <string>
#include <vector>

namespace rubble {

// software: this program, on the processor, with the same bits on every machine. gl: a graphics card, by OpenGL; steps of
// 8 bits differ here and there.
enum class DeviceKind { software, gl };

// As people name them, in the order of DeviceKind.
inline const std::vector<std::string>& device_names() {
  static const std::vector<std::string> names{"software", "gl"};
  return names;
}

}  // namespace rubble
