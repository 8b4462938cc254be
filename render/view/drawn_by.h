// Whether the graphics device draws, or the processor in its place.
#pragma once

#include <string>

#include "render/gl/gl_context.h"
#include "render/view/render_options.h"

namespace rubble {

bool drawn_by_processor(DrawnBy choice, const GlInfo& info);

// Who shades the pixels of this context if nobody chooses: "device", or "processor" and its instruction set.
std::string describe_shading(const GlInfo& info);

}  // namespace rubble
