// What each part of an image shows, so that each is coloured by a shader that can do that and no
// more: software drivers do not skip branches.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"

namespace rubble {

enum class TileContent { sky, near_surfaces, surfaces, mixed };  // as CONTENT in resolve.frag.glsl

// A rectangle of pixels, all of one content.
struct TileRun {
  TileContent content;      // of every pixel of the run
  int x, y, width, height;  // rectangle of the image; unit: pixel
};

struct ImageTiles {
  std::vector<TileRun> runs;        // a row of tiles high; ordered by content, row and column
  int first_row = 0, last_row = 0;  // all surfaces are in rows [first_row, last_row)
  float nearest_value = 0;          // the largest depth value
};

// depth_values: near / Z, 0: nothing. near_value: a surface is near where its value is above this. The same for
// any number of threads.
ImageTiles cut_into_tiles(const std::vector<float>& depth_values, int width, int height,
                          float near_value, ThreadPool& pool);

}  // namespace rubble
