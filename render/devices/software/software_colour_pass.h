// ColourPass with the shading of render/shading.
#pragma once

#include <memory>
#include <vector>

#include "render/colour/colour_pass.h"
#include "render/devices/software/shadow_map.h"
#include "render/geometry/ground_map.h"
#include "render/geometry/scene_tables.h"
#include "render/materials/textures.h"
#include "render/shading/wide_shader.h"

namespace rubble {

// What they refer to must outlive it.
std::unique_ptr<ColourPass> make_software_colour_pass(const PreparedScene& scene, const SceneTables& tables,
                                                      const SoftwareShadowMap& shadows, const FrameLight& light,
                                                      const GroundMap& ground, const std::vector<PatternImage>& patterns,
                                                      const WideShader& shader, ThreadPool& pool);

}  // namespace rubble
