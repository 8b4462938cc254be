// What the shadow maps of all lights look at, and what every device must know to draw them. One view for narrow spots
// and for the sun (two where there are surroundings), six (a cube) for the others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/camera/edge_blocks.h"
#include "render/geometry/geometry.h"
#include "render/lighting/lighting.h"

namespace rubble {

// A directional view as finding the edges of its shadows needs it.
struct EdgeView {
  static constexpr int kTile = 4;    // side of a tile; unit: texel of the map
  static constexpr int kMargin = 3;  // what comparing adds to the reach of an edge; unit: texel of the map
  // An edge reaches no farther, so that a sun at the horizon does not make all of the map an edge; unit: tile.
  static constexpr int kMostReach = 24;
  // A smaller difference of depth between texels is the slope of a surface; unit: texel.
  static constexpr double kLeastStep = 3;

  std::array<float, 3> ground{};  // its depth at the lower left corner, and how it grows to the right and up
  double depth_metres = 1;        // along the light, of depth 0 to 1
  double texel = 0.001;           // the narrower side of one; unit: m

  int reach() const;  // of the farthest edge; unit: tile
  float reach_a_depth() const { return float(double(kSunRadius) * depth_metres / (kTile * texel)); }  // unit: tile
  static constexpr float kLeastReach = float(kMargin) / kTile;                                        // unit: tile
  float least_step() const { return float(kLeastStep * texel / depth_metres); }  // difference of depth
};

// Of a map; columns [x0, x1) and rows [y0, y1).
struct TexelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
// Fewer rectangles that cover the same: those that overlap become one where that is no larger.
std::vector<TexelRect> merge_rects(std::vector<TexelRect> rects);

// Depth in a map is 0 to 1 where the view has it so, and clamped to that; where nothing is drawn it is 1.
struct ShadowViews {
  using Rows = std::array<std::array<double, 4>, 4>;  // of clip_from_world: -1 to 1, -1 to 1, 0 to 1

  struct Light {
    // Layers of the light: 1 or 6; 2 of one that is directional, the second over the surroundings.
    int first_view = 0, views = 1;
    bool directional = false;
    float texel = 0;      // width across the beam (directional; m) or per metre of distance
    float far_texel = 0;  // of the second layer of a directional one; m
  };

  // most_side: with less for many views; unit: texel.
  ShadowViews(const PreparedScene& scene, const LightSet& set, int most_side);

  int side = 0;                                                      // of a layer; unit: texel
  std::vector<Light> lights;                                         // in the order of LightSet::lights
  std::vector<Rows> rows;                                            // one a layer
  std::vector<std::array<std::array<float, 4>, 4>> clip_from_world;  // the same

  // Where the lights are now.
  void place(const PreparedScene& scene, const LightSet& set);
  bool has_sun() const { return lights.front().directional; }
  std::vector<EdgeView> sun_edges() const;  // one a layer of the sun; empty: the main light is none
  std::vector<EdgeLayer> edge_layers(const std::vector<EdgePyramid>& pyramids) const;
  // Where moving pieces may be on a directional layer.
  std::vector<TexelRect> moving_rects(const PreparedScene& scene, std::size_t view) const;
};

// What is drawn into a map.
enum class ShadowPart { resting, moving, all };
bool casts_shadow(const PlacedMesh& piece, ShadowPart part);
std::array<std::array<float, 4>, 4> clip_from_mesh(const ShadowViews::Rows& rows, const PlacedMesh& piece);

// Of the finest level of a mesh: all but glass, which lets light pass.
bool is_opaque(const PreparedMesh& mesh, std::uint32_t triangle);

}  // namespace rubble
