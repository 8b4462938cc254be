#include "render/view/drawn_by.h"

#include "render/shading/wide_shader.h"

namespace rubble {

bool drawn_by_processor(DrawnBy choice, const GlInfo& info) {
  if (choice != DrawnBy::automatic) return choice == DrawnBy::processor;
  for (const char* software : {"llvmpipe", "softpipe", "swrast"})
    if (info.renderer.find(software) != std::string::npos) return true;
  return false;
}

std::string describe_shading(const GlInfo& info) {
  if (!drawn_by_processor(DrawnBy::automatic, info)) return "device";
  return std::string("processor (") + wide_shaders().front().name + ")";
}

}  // namespace rubble
