// Where the sun's shadow map has edges: only there is a shadow soft, and only there pixels compare it more than once.
// See shaders/shadow_edges.frag.glsl.
#pragma once

#include <vector>

#include "render/gl/gl_objects.h"
#include "render/passes/shadow_views.h"

namespace rubble {

class ShadowEdgePass {
 public:
  // side: of the map; unit: texel. views: of its first layers.
  ShadowEdgePass(const Gl& gl, int side, std::vector<EdgeView> views);

  // values: the map, without comparison. Of all of it.
  void find(const GlTexture& values);
  // Keeps what was found: of what rests.
  void keep();
  // Of what is kept, but where the map has changed. One list of texels for each view.
  void find_again(const GlTexture& values, const std::vector<std::vector<TexelRect>>& changed);

  const GlTexture& edges() const { return edges_; }  // two words a tile, see shaders/shadow_edges.frag.glsl
  const GlBuffer& pyramids() const { return pyramids_; }  // of the same, one a view: see shaders/edge_blocks.comp.glsl

 private:
  GlTexture make_tiles(int layers) const;
  std::vector<GlFramebuffer> make_targets(const GlTexture& tiles, int layers) const;
  void copy(const GlTexture& from, const GlTexture& to) const;
  void find_in(const GlTexture& values, std::size_t layer, const std::vector<TexelRect>& tiles);
  void build_pyramids();
  // Draws all rectangles, grown by so many tiles.
  void draw(const GlProgram& program, const GlTexture& source, const GlFramebuffer& target,
            const std::vector<TexelRect>& tiles, int grow_x, int grow_y);

  const Gl& gl_;
  std::vector<EdgeView> views_;
  int map_side_;
  int side_;  // unit: tile
  GlProgram find_, spread_, pyramid_;
  GlBuffer block_, pyramids_;
  GlVertexArray empty_array_;
  GlTexture found_, edges_;                  // one layer a view
  GlTexture kept_found_, kept_edges_;        // the same, of what rests
  GlTexture across_;                         // found_ of one layer, spread along x
  std::vector<GlFramebuffer> into_found_, into_edges_, into_across_;  // one a layer
};

}  // namespace rubble
