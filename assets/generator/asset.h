// What a pack is made of, and its way to files.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "assets/generator/bar.h"
#include "assets/generator/solid.h"
#include "assets/generator/surface_mesh.h"

namespace rubble::generator {

// The recipe of one asset. Lengths in metres, frame Z up.
struct Recipe {
  std::string name;
  Solid solid;         // without cells: bars only
  double cell = 0.01;  // of the sampling grid
  std::vector<Bar> bars;
  bool fit_parts = true;  // shrink the cells onto the surface; else `parts` or the cells as given
  std::vector<std::vector<Vec3>> parts;         // given collision parts, besides those of the bars
  std::array<int, 3> triangles{2000, 500, 60};  // of the solid, per level
  double max_edge = 0.15;                       // longest edge of level 0; doubles with each level
  std::string material = "reinforced_concrete";
  double scale_min = 1, scale_max = 1;
  double weight = 1;
  std::vector<std::string> tags;
};

struct Asset {
  Recipe recipe;
  std::vector<TriangleMesh> levels;      // finest first
  std::vector<std::vector<Vec3>> parts;  // corners of convex collision parts
};

Asset make_asset(const Recipe& recipe);

// An asset made of others: each link as its table in pack.lua, without the braces.
struct ArticulatedRecipe {
  std::string name;
  std::vector<std::string> links;
  double scale_min = 1, scale_max = 1;
  double weight = 0;
  std::vector<std::string> tags;
};

struct Pack {
  std::string name;
  std::vector<Recipe> recipes;
  std::vector<ArticulatedRecipe> articulated = {};
};

Pack concrete_pack();

// Writes pack.lua, pack.mtl and the OBJ files into the folder, which is made when missing. Each
// file appears under its name only when complete. Throws RunError.
void write_pack(const Pack& pack, const std::string& folder);

}  // namespace rubble::generator
