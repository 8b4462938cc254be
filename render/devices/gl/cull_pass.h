// What of a scene is drawn, chosen on the card: see passes/visibility_pass.h, which chooses on the processor, and the shaders
// cull*. Internal to render/devices/gl.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "render/devices/gl/draw_list.h"
#include "render/devices/gl/gl_geometry.h"
#include "render/gl/gl_exchange.h"
#include "render/passes/triangle_raster.h"

namespace rubble {

class CullPass {
 public:
  CullPass(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry);

  // Of a picture of that size. The list has a record a candidate, in their order, with the eye.
  void begin(const std::vector<DrawCandidate>& candidates, DrawList& list, int width, int height);
  // Draws what showed the time before; then, by the depth that this left, what else shows. prepare: binds what draws.
  using Prepare = std::function<void()>;
  void draw_first(DrawList& list, const Prepare& prepare);
  void draw_others(DrawList& list, const GlTexture& depth, const Prepare& prepare);
  GlReadback::Part triangles() const { return {triangles_.name(), 0, 4}; }  // number of those drawn of this picture

 private:
  struct Programs {
    GlProgram first, others, scan, emit, pyramid_first, pyramid;
  };
  void give_clusters(const PreparedScene& scene, const GlGeometry& geometry);
  void build_pyramid(const GlTexture& depth);
  void draw(DrawList& list, const GlProgram& choose, const Prepare& prepare);

  const Gl& gl_;
  const PreparedScene& scene_;
  Programs programs_;
  std::vector<std::vector<std::uint32_t>> first_cluster_;  // of each mesh and level, in the table
  GlBuffer clusters_, flags_, candidates_, runs_, pyramid_, commands_, count_, triangles_;
  GLint candidate_count_ = 0;
  std::uint32_t most_runs_ = 0;
  int width_ = 0, height_ = 0;
  bool drawn_before_ = false;
};

}  // namespace rubble
