// The shadow maps of all lights on the graphics card. What rests is drawn once, what moves whenever it has moved, and all
// that a carried light sees whenever that is. Internal to render/devices/gl.
#pragma once

#include <memory>

#include "render/devices/gl/gl_geometry.h"
#include "render/devices/gl/shadow_edge_pass.h"
#include "render/passes/shadow_views.h"

namespace rubble {

class GlShadowPass {
 public:
  // What they refer to must outlive it. most_side: as ShadowViews.
  GlShadowPass(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry, const LightSet& lights,
               int most_side);

  // Pieces and carried lights are where they are in the scene now.
  void move();

  const ShadowViews& views() const { return views_; }
  const GlTexture& depth() const { return depth_; }    // array of GL_DEPTH_COMPONENT32F, compared by GL_LEQUAL
  const GlTexture& values() const { return values_; }  // the same, without comparison
  const ShadowEdgePass* edges() const { return edges_.get(); }  // of the main light's layers; null: that is no sun

 private:
  GlTexture make_layers() const;
  std::vector<GlFramebuffer> make_targets(const GlTexture& layers) const;
  GlTexture make_values(const GlTexture& layers) const;
  // Into depth_, of the views from that one on. What moves is drawn on what is there, all else on nothing.
  void draw_layers(ShadowPart part, std::size_t from = 0);
  void draw_view(const ShadowViews::Rows& rows, ShadowPart part);

  const Gl& gl_;
  const PreparedScene& scene_;
  const GlGeometry& geometry_;
  const LightSet& lights_;
  ShadowViews views_;
  bool moves_ = false;
  GlProgram program_;
  std::unique_ptr<ShadowEdgePass> edges_;
  GlTexture depth_, values_;
  std::vector<GlFramebuffer> targets_;  // the layers of depth_
  GlTexture resting_;  // of what rests alone; only where something moves
};

}  // namespace rubble
