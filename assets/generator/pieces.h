// The pieces of the bundled packs, by family.
#pragma once

#include <vector>

#include "assets/generator/asset.h"

namespace rubble::generator {

// What many pieces have.
inline constexpr Surface kCast = Surface::concrete_cast;
inline constexpr Surface kBroken = Surface::concrete_fracture;
inline constexpr Surface kWood = Surface::timber;

std::vector<Recipe> masonry_pieces();  // bricks and blocks
std::vector<Recipe> chunk_pieces();    // broken lumps of concrete
std::vector<Recipe> slab_pieces();     // broken floor slabs with bars
std::vector<Recipe> frame_pieces();    // columns, beams, large slabs, walls
std::vector<Recipe> hollow_pieces();   // pipes and culverts
std::vector<Recipe> rebar_pieces();    // loose bars

// What hangs together by bars, clips and hinges, and pieces that are made for it alone.
std::vector<ArticulatedRecipe> articulated_concrete();
std::vector<ArticulatedRecipe> articulated_residential();
std::vector<ArticulatedRecipe> articulated_parking();
std::vector<Recipe> facade_pieces();
std::vector<Recipe> door_frames();
std::vector<Recipe> open_cars();

std::vector<Recipe> concrete_fragments();  // of culverts and planks, and lumps with bars
std::vector<Recipe> parking_concrete();    // double tees, wheel stops
std::vector<Recipe> bridge_concrete();     // decks, girders, barriers

std::vector<Recipe> timber_pieces();     // beams, studs, plywood
std::vector<Recipe> drywall_pieces();    // torn sheets
std::vector<Recipe> joinery_pieces();    // windows and doors
std::vector<Recipe> furniture_pieces();  // chairs, tables, sofa, mattress, refrigerator

std::vector<Recipe> guard_pieces();  // guard rails and a post
std::vector<Recipe> bridge_steel();  // girders, rails, clusters of bars

std::vector<Recipe> victim_pieces();  // posed figures of people

}  // namespace rubble::generator
