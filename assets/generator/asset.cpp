#include "assets/generator/asset.h"

#include "assets/generator/fit.h"

namespace rubble::generator {
namespace {

// Bars of a level: sides and ring spacing.
void append_bars(SurfaceMesh& mesh, const std::vector<Bar>& bars, int level) {
  static const int kSides[3] = {10, 6, 4};
  static const double kSpacing[3] = {0.06, 0.15, 9};
  for (const Bar& bar : bars) append(mesh, mesh_bar(bar, kSides[level], kSpacing[level]));
}

std::vector<std::vector<Vec3>> warped(std::vector<std::vector<Vec3>> parts, const Warp& warp) {
  if (!warp) return parts;
  for (auto& part : parts) {
    for (Vec3& p : part) p = warp(p);
  }
  return parts;
}

std::vector<std::vector<Vec3>> make_parts(const Recipe& r, const SurfaceMesh& finest) {
  if (!r.collides) return {};
  std::vector<std::vector<Vec3>> parts;
  if (!r.parts.empty()) {
    parts = warped(r.parts, r.warp);
  } else if (!r.regions.empty()) {
    parts = fit_regions(r.solid, r.regions, finest, r.warp);
  } else if (!r.solid.cells.empty()) {
    parts = r.fit_parts ? fit_parts(r.solid, finest) : warped(cell_parts(r.solid), r.warp);
  }
  for (const Bar& bar : r.bars) {
    if (!bar.collides) continue;
    for (auto& part : bar_parts(bar)) parts.push_back(part);
  }
  for (auto& part : parts) {
    for (Vec3& p : part) p = rounded_for_file(p);
  }
  return parts;
}

// An asset before its corners get normals.
struct Body {
  std::array<SurfaceMesh, 3> levels;
  std::vector<std::vector<Vec3>> parts;
};

Body make_body(const Recipe& recipe) {
  Body body;
  SurfaceMesh solid;
  if (!recipe.solid.cells.empty()) solid = mesh_solid(recipe.solid, recipe.cell);
  body.parts = make_parts(recipe, solid);
  for (const Sheet& sheet : recipe.sheets) append(solid, mesh_sheet(sheet));
  if (recipe.warp) {
    for (Vec3& p : solid.positions) p = recipe.warp(p);
  }
  double max_edge = recipe.max_edge;
  for (int level = 0; level < 3; ++level) {
    if (!solid.triangles.empty()) solid = decimate(solid, {recipe.triangles[level], max_edge});
    if (level > 0 && int(solid.triangles.size()) > recipe.triangles[level] * 5 / 4) {
      solid = decimate(solid, {recipe.triangles[level], max_edge, 0.12});
    }
    body.levels[level] = solid;
    append_bars(body.levels[level], recipe.bars, level);
    max_edge = level == 0 ? 3 * max_edge : 1e9;
  }
  for (const Recipe& more : recipe.attached) {
    const Body other = make_body(more);
    for (int level = 0; level < 3; ++level) append(body.levels[level], other.levels[level]);
    body.parts.insert(body.parts.end(), other.parts.begin(), other.parts.end());
  }
  return body;
}

}  // namespace

Asset make_asset(const Recipe& recipe) {
  Body body = make_body(recipe);
  Asset asset{recipe, {}, std::move(body.parts)};
  for (const SurfaceMesh& level : body.levels) asset.levels.push_back(finish(level, kCreaseDeg));
  return asset;
}

}  // namespace rubble::generator
