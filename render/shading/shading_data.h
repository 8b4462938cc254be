// What the shading on the processor reads: plain numbers, so that code of every instruction set
// can.
#pragma once

#include <cstdint>

#include "render/shading/frame_block.h"

namespace rubble {

// Square images of RGBA8 with their halved levels, all in one piece: of each image the levels in
// turn.
struct MipImages {
  const std::uint32_t* texels = nullptr;  // red in the lowest byte
  int size = 1, levels = 1;               // side of the finest level, a power of two; unit: texel
  int stride = 1;                         // from image to image; unit: texel
  std::int32_t first_texel[16] = {};      // of each level, in an image
};

// Where the lamp's shadows are, at half the size of the image; as contact.frag.glsl.
struct OpennessGrid {
  const float* lamp = nullptr;     // 1: in sight, 0: hidden; null: there is no lamp
  int width = 0, height = 0;       // of the grid
  int stride = 0;                  // from row to row
};

// Edges of the sun's shadows, see camera/edge_blocks.h.
struct SunEdges {
  const float* blocks = nullptr;  // of 4 x 4 pixels in rows: depth of the nearest edge that one
                                  // meets; 2: none. Null: hard shadows
  int blocks_across = 0;
  const std::uint16_t* tiles[2] =
      {};  // of each layer of the sun, two numbers a tile: EdgePyramid::Range
  int tiles_across = 0, texels_a_tile = 1;  // side of a layer, and of a tile
  float sun_radius = 0;                     // of its disc; unit: rad
};

struct ShadingData {
  FrameBlock frame;  // what is the same for all pixels

  struct Light {
    int type = 0;                   // 0 directional, 1 spot, 2 point
    int first_view = 0, views = 1;  // layers of the shadow map, as ShadowViews::Light
  };
  Light lights[kMostShadedLights];  // the main one first
  int light_count = 0;              // range: 1 to kMostShadedLights
  // Whether the lamp shows, air that is not clear, water on surfaces, looks that shine, and a
  // street about the pile.
  bool lamp = false, air = false, wet = false, glow = false, surrounded = false;
  float soil = 0;       // layer of the ground's texture
  float veil_from = 0;  // unit: m
  int glass_look = -1;  // the look that is clear; below 0: nothing is
  int paint_count = 0, painted_look = -1,
      paint_side = 1;  // as PAINTS, PAINTED and PAINT_SIDE in shaders/paint.glsl

  int width = 0, height = 0;  // of the image
  int every = 1;  // shades each so-many-th pixel in both directions, the first at half of that
  const std::uint32_t* ids = nullptr;   // two a pixel: placed mesh + 1, name of the triangle
  std::uint32_t any_triangle = 0;       // name of one of the first placed mesh
  const float* depth_values = nullptr;  // near / Z; 0: nothing; below 0: nothing, and dark
  const float* behind = nullptr;        // glass, four a pixel: radiance, and 0 where it is dark; null: nothing is
  const float* lens_rays = nullptr;     // four a pixel, as RayPass has them; null: a pinhole
  const float* row_poses = nullptr;     // three rows of four numbers for each row of pixels

  // Rows of four words; of light two.
  const void *vertices = nullptr, *triangles = nullptr, *placed = nullptr, *light = nullptr,
             *paint = nullptr;
  MipImages looks, paints;                            // of Pattern by number; of PaintLayers
  const std::uint8_t* ground_map = nullptr;           // two a texel
  int ground_side = 1;                                // unit: texel
  const float* sky_map = nullptr;                     // three a texel
  int sky_side = 1;                                   // unit: texel
  const float* air_table = nullptr;                   // four an entry
  int air_columns = 1, air_rows = 1, air_slices = 1;  // of the table, as AirVolume has them
  const float* shadow_map = nullptr;                  // layers of depth
  int shadow_side = 1;                                // of a layer; unit: texel
  OpennessGrid openness;                              // of this image
  SunEdges sun_edges;                                 // of this image
};

// What comes out for each shaded pixel, in rows of a grid; one of the three.
struct ShadedPixels {
  std::uint32_t* display = nullptr;  // RGBA8
  float* linear = nullptr;           // red, green, blue, 1, or 0 where it is dark; unit: kcd/m2
  float* stops = nullptr;            // log2 of luminance; below -1000: none
  int width = 0, height = 0;         // of the grid
  // Of blocks of 4 x 4 pixels, in rows: 0: it is left out. Null: none is.
  const std::uint8_t* blocks = nullptr;
};

}  // namespace rubble
