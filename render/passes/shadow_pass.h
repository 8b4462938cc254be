// The shadow maps of all lights. What rests is drawn once, what moves whenever it has moved, and all that a carried
// light sees whenever that is. One view for narrow spots and for the sun (two where there are surroundings), six (a
// cube) for the others.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/lighting/lighting.h"
#include "render/passes/shadow_edge_pass.h"

namespace rubble {

struct ShadowMap {
  GlTexture depth;  // array of GL_DEPTH_COMPONENT32F, compared by GL_LEQUAL
  GlTexture values;  // the same, without comparison
  std::vector<float> texels;  // the same where the processor shades, layer by layer; else empty
  int side = 0;               // of a layer; unit: texel
  const ShadowEdgePass* edges = nullptr;  // of the layers of the main light; null: that is no sun
  std::vector<std::array<std::array<float, 4>, 4>> clip_from_world;  // rows, one a layer
  struct Light {
    // Layers of the light: 1 or 6; 2 of one that is directional, the second over the surroundings.
    int first_view = 0, views = 1;
    float texel = 0;                // width across the beam (directional; m) or per metre of distance
    float far_texel = 0;            // of the second layer of a directional one; m
  };
  std::vector<EdgeLayer> edge_layers() const;
  std::vector<Light> lights;  // in the order of LightSet::lights
};

class ShadowPass {
 public:
  // Draws what rests. The lights must outlive it. size: side of one view at most, with less for many views; unit: texel.
  // read_back: fills ShadowMap::texels.
  ShadowPass(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry,
             const LightSet& lights, int size, bool read_back);

  // Adds what moves, where it is in the scene now, and puts carried lights where they are.
  void draw_moving();
  const ShadowMap& map() const { return map_; }

 private:
  using Rows = std::array<std::array<double, 4>, 4>;
  GlTexture make_layers() const;
  GlTexture make_values(const GlTexture& layers) const;
  bool has_sun() const;
  std::vector<ShadowEdgePass::View> edge_views() const;
  void find_moving_edges();
  void list_views();
  using Rect = ShadowEdgePass::Rect;
  std::vector<Rect> moving_rects(std::size_t view) const;
  void read_texels();
  void read_moved_texels();
  void read_part(std::size_t view, const Rect& rect);
  enum class What { resting, moving, all };
  // Of the views from that one on. What rests is drawn on nothing, what moves on what is there.
  void draw_layers(const GlTexture& layers, What what, std::size_t from = 0);
  void draw_view(const Rows& rows, What what);

  const Gl& gl_;
  const PreparedScene& scene_;
  const GpuGeometry& geometry_;
  const LightSet& lights_;
  std::vector<Rows> views_;  // one a layer
  int size_;
  bool moves_, read_back_;
  GlProgram program_;
  std::unique_ptr<ShadowEdgePass> edges_;  // null: the main light is no sun
  GlTexture resting_;  // of what rests alone; only where something moves
  std::vector<std::vector<Rect>> moved_;  // by view: where something moved that was read back last
  ShadowMap map_;
};

}  // namespace rubble
