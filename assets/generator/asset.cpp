#include "assets/generator/asset.h"

#include "assets/generator/fit.h"

namespace rubble::generator {
namespace {

constexpr double kCreaseDeg = 42;

// Bars of a level: sides and ring spacing.
void append_bars(SurfaceMesh& mesh, const std::vector<Bar>& bars, int level) {
  static const int kSides[3] = {10, 6, 4};
  static const double kSpacing[3] = {0.06, 0.15, 9};
  for (const Bar& bar : bars) append(mesh, mesh_bar(bar, kSides[level], kSpacing[level]));
}

std::vector<std::vector<Vec3>> make_parts(const Recipe& recipe, const SurfaceMesh& finest) {
  std::vector<std::vector<Vec3>> parts = recipe.parts;
  if (parts.empty() && !recipe.solid.cells.empty()) {
    parts = recipe.fit_parts ? fit_parts(recipe.solid, finest) : cell_parts(recipe.solid);
  }
  for (const Bar& bar : recipe.bars) {
    if (!bar.collides) continue;
    for (auto& part : bar_parts(bar)) parts.push_back(part);
  }
  for (auto& part : parts) {
    for (Vec3& p : part) p = rounded_for_file(p);
  }
  return parts;
}

}  // namespace

Asset make_asset(const Recipe& recipe) {
  Asset asset{recipe, {}, {}};
  SurfaceMesh solid;
  if (!recipe.solid.cells.empty()) solid = mesh_solid(recipe.solid, recipe.cell);
  asset.parts = make_parts(recipe, solid);
  double max_edge = recipe.max_edge;
  for (int level = 0; level < 3; ++level) {
    if (!solid.triangles.empty()) solid = decimate(solid, {recipe.triangles[level], max_edge});
    SurfaceMesh whole = solid;
    append_bars(whole, recipe.bars, level);
    asset.levels.push_back(finish(whole, kCreaseDeg));
    max_edge = level == 0 ? 3 * max_edge : 1e9;
  }
  return asset;
}

}  // namespace rubble::generator
