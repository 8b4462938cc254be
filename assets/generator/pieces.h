// The pieces of the bundled packs, by family.
#pragma once

#include <vector>

#include "assets/generator/asset.h"

namespace rubble::generator {

std::vector<Recipe> masonry_pieces();  // bricks and blocks
std::vector<Recipe> chunk_pieces();    // broken lumps of concrete
std::vector<Recipe> slab_pieces();     // broken floor slabs with bars
std::vector<Recipe> frame_pieces();    // columns, beams, large slabs, walls
std::vector<Recipe> hollow_pieces();   // pipes and culverts
std::vector<Recipe> rebar_pieces();    // loose bars

std::vector<ArticulatedRecipe> articulated_concrete();  // pieces that hang together by bars

}  // namespace rubble::generator
