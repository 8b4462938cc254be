// What a pack is made of, and its way to files.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "assets/generator/solid.h"
#include "assets/generator/surface_mesh.h"
#include "assets/generator/thin_shapes.h"

namespace rubble::generator {

// Bends what was designed straight: from where a point was made to where it ends up. Smooth, and
// without folds over itself.
using Warp = std::function<Vec3(const Vec3&)>;

// The recipe of one asset. Lengths in metres, frame Z up.
struct Recipe {
  std::string name;
  Solid solid;         // without cells: bars and sheets only
  double cell = 0.01;  // of the sampling grid
  std::vector<Bar> bars;
  std::vector<Sheet> sheets;         // with no collision parts of their own
  std::vector<Recipe> attached;      // closed bodies with a wear of their own, in the same frame
  Warp warp;                         // of solid, sheets and parts (bars and attached ones: theirs)
  // What collides, besides the bars and what is attached: `parts` as given, else one part for each
  // of the `regions`, else for each cell of the solid; the last two are moved onto the surface.
  std::vector<std::vector<Vec3>> parts;
  std::vector<Cell> regions;  // convex, roughly around what one part shall hold
  bool fit_parts = true;      // false: the cells just as they are
  bool collides = true;       // false: drawn only
  std::array<int, 3> triangles{2000, 500, 60};  // of the solid, per level
  double max_edge = 0.15;                       // longest edge of level 0; doubles with each level
  std::string material = "reinforced_concrete";
  double density = 0;  // instead of the material's, where it is not 0; unit: kg/m3
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

// The bundled ones.
std::vector<std::string> pack_names();
// Throws RunError for another name.
Pack make_pack(const std::string& name);

// Writes pack.lua, pack.mtl and the OBJ files into the folder, which is made when missing. Each
// file appears under its name only when complete. Throws RunError.
void write_pack(const Pack& pack, const std::string& folder);

}  // namespace rubble::generator
