// The paints of a scene (kernel/base/mesh.h) as the renderers read them: all images of one size.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "kernel/base/mesh.h"
#include "render/materials/texture_stack.h"

namespace rubble {

struct PaintLayers {
  struct Paint {
    Vec3f colour;  // these as in SurfacePaint
    float roughness = 1, metalness = 0, reflectance = 0;
    int albedo = -1, relief = -1;  // numbers in `images`; -1: none
  };
  std::vector<Paint> paints;  // in the order in which they were given
  TextureStack images;        // of albedos, encoded as sRGB, and of reliefs
  int image_count = 0;
};

// Images take at most half a gigabyte without their halved levels: of very many, finer ones lose detail.
PaintLayers make_paint_layers(const std::vector<std::shared_ptr<const SurfacePaint>>& paints);

// Mean linear-light albedo of a painted surface of a mesh, over its area.
Vec3f mean_paint(const TriangleMesh& mesh, std::size_t surface);

}  // namespace rubble
