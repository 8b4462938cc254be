// Where the sun's shadow map has edges: only there is a shadow soft, and only there pixels compare it more than once.
// See shaders/shadow_edges.frag.glsl and shaders/sun_shadow.glsl.
#pragma once

#include <array>
#include <vector>

#include "render/camera/edge_blocks.h"
#include "render/gl/gl_objects.h"

namespace rubble {

class ShadowEdgePass {
 public:
  static constexpr int kTile = 4;    // side of a tile; unit: texel of the map
  static constexpr int kMargin = 3;  // what comparing adds to the reach of an edge; unit: texel of the map

  // One layer of the map.
  struct View {
    std::array<float, 3> ground{};  // its depth at the lower left corner, and how it grows to the right and up
    double depth_metres = 1;        // along the light, of depth 0 to 1
    double texel = 0.001;           // the narrower side of one; unit: m
  };
  // Of the tiles of a layer, or of its texels. The last ones are not of it.
  struct Rect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  };

  // side: of the map; unit: texel. views: of its first layers.
  ShadowEdgePass(const Gl& gl, int side, std::vector<View> views);

  // values: the map, without comparison. Of all of it.
  void find(const GlTexture& values);
  // Keeps what was found: of what rests.
  void keep();
  // Of what is kept, but where the map has changed. One list of texels for each view.
  void find_again(const GlTexture& values, const std::vector<std::vector<Rect>>& changed);

  const GlTexture& edges() const { return edges_; }  // two words a tile, see shaders/shadow_edges.frag.glsl
  const std::vector<EdgePyramid>& pyramids() const { return pyramids_; }  // the same, one a view

 private:
  GlTexture make_tiles(int layers) const;
  void copy(const GlTexture& from, const GlTexture& to) const;
  void find_in(const GlTexture& values, std::size_t layer, const std::vector<Rect>& tiles);
  void read();
  int reach_of(const View& view) const;
  // Draws all rectangles, grown by so many tiles.
  void draw(const GlProgram& program, const GlTexture& source, const GlTexture& target, std::size_t layer,
            const std::vector<Rect>& tiles, int grow_x, int grow_y);

  const Gl& gl_;
  std::vector<View> views_;
  int map_side_;
  int side_;  // unit: tile
  GlProgram find_, spread_;
  GlBuffer block_;
  GlVertexArray empty_array_;
  GlTexture found_, edges_;                  // one layer a view
  GlTexture kept_found_, kept_edges_;        // the same, of what rests
  std::vector<EdgePyramid> pyramids_;
  GlTexture across_;                         // found_ of one layer, spread along x
};

// Fewer rectangles that cover the same: those that overlap become one where that is no larger.
std::vector<ShadowEdgePass::Rect> merge_rects(std::vector<ShadowEdgePass::Rect> rects);

}  // namespace rubble
