// Where the sun's shadow map has edges: only there is a shadow soft, and only there pixels compare it more than once.
// The formulas of shaders/shadow_edges.frag.glsl. Internal to render/devices/software.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/passes/shadow_views.h"

namespace rubble {

class ShadowEdges {
 public:
  // side: of the map; unit: texel. views: of its first layers.
  ShadowEdges(int side, std::vector<EdgeView> views, ThreadPool& pool);

  // texels: the map, layer by layer. Of all of it.
  void find(const std::vector<float>& texels);
  // Keeps what was found: of what rests.
  void keep() { kept_ = layers_; }
  // Of what is kept, but where the map has changed. One list of texels for each view.
  void find_again(const std::vector<float>& texels, const std::vector<std::vector<TexelRect>>& changed);

  const std::vector<EdgePyramid>& pyramids() const { return pyramids_; }  // one a view

 private:
  using Tile = std::array<std::uint32_t, 2>;  // as the shader writes it
  struct Layer {
    std::vector<Tile> found, edges;
  };
  void find_in(const float* texels, std::size_t layer, const std::vector<TexelRect>& tiles);
  Tile find_tile(const float* texels, const EdgeView& view, int x, int y) const;
  Tile spread(const std::vector<Tile>& tiles, int x, int y, int along_x, int along_y, int reach) const;
  // Calls make(x, y) for the tiles of all rectangles, grown by so many.
  template <typename Make>
  void fill(const std::vector<TexelRect>& tiles, int grow_x, int grow_y, std::vector<Tile>& out, const Make& make);
  void build_pyramids();

  std::vector<EdgeView> views_;
  int map_side_;
  int side_;  // unit: tile
  ThreadPool& pool_;
  std::vector<Layer> layers_, kept_;
  std::vector<Tile> across_;  // found of one layer, spread along x
  std::vector<EdgePyramid> pyramids_;
};

}  // namespace rubble
