#include "app/scene/look_pictures.h"

#include <cmath>
#include <map>
#include <memory>

#include "io/base/srgb.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/model/fines.h"
#include "kernel/model/surroundings.h"
#include "render/materials/surface_appearance.h"
#include "render/materials/textures.h"

namespace rubble {
namespace {

constexpr int kSide = 256;  // of a picture; unit: texel

// The albedo of render/shading/find_surface.h, without dust and differences between pieces.
SurfacePaint draw(const SurfaceAppearance& look, const PatternImage& pattern) {
  SurfacePaint paint;
  paint.roughness = 0.9f;
  paint.albedo.side = pattern.size;
  for (std::size_t i = 0; i < pattern.texels.size(); i += 4) {
    const float bright = float(pattern.texels[i + 2]) / 255, mask = float(pattern.texels[i + 3]) / 255;
    const Vec3f plain = look.dark + (look.light - look.dark) * bright;
    const Vec3f accent = look.accent * (look.pattern == Pattern::soil ? 0.55f + 0.7f * bright : 1.0f);
    const Vec3f albedo = plain + (accent - plain) * mask;
    for (int c = 0; c < 3; ++c) paint.albedo.texels.push_back(srgb8_from_linear(double(albedo[c])));
    paint.albedo.texels.push_back(255);
  }
  paint.sha256 = look.name;
  return paint;
}

PaintCorner project(const Vec3f& p, const Vec3f& face, float tile) {
  const float x = std::fabs(face.x), y = std::fabs(face.y), z = std::fabs(face.z);
  PaintCorner corner;
  if (z >= x && z >= y)
    corner.u = p.x, corner.v = p.y;
  else if (x >= y)
    corner.u = p.y, corner.v = p.z;
  else
    corner.u = p.x, corner.v = p.z;
  corner.u /= tile, corner.v /= tile;
  return corner;
}

class Painter {
 public:
  explicit Painter(int threads)
      : patterns_(make_patterns_once(DiskCache(DiskCache::usual_folder()), kSide, threads)) {}

  // Null where nothing of it has a look without a paint.
  std::shared_ptr<const TriangleMesh> paint(const TriangleMesh& mesh) {
    std::vector<const SurfaceAppearance*> looks(mesh.surface_names.size(), nullptr);
    bool any = false;
    for (std::size_t s = 0; s < looks.size(); ++s) {
      if (!mesh.paint_of(s)) looks[s] = find(mesh.surface_names[s]);
      any = any || looks[s];
    }
    if (!any) return nullptr;
    auto painted = std::make_shared<TriangleMesh>(mesh);
    painted->paints.resize(looks.size());
    painted->paint_corners.resize(mesh.triangles.size());
    for (std::size_t s = 0; s < looks.size(); ++s)
      if (looks[s]) painted->paints[s] = paint_of(*looks[s]);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const SurfaceAppearance* const look = looks[mesh.surfaces.empty() ? 0 : mesh.surfaces[t]];
      if (!look) continue;
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3f face = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
      for (std::size_t k = 0; k < 3; ++k)
        painted->paint_corners[t][k] = project(mesh.positions[mesh.triangles[t][k]], face, look->tile);
    }
    return painted;
  }

 private:
  static const SurfaceAppearance* find(const std::string& name) {
    for (const SurfaceAppearance& look : all_surface_appearances())
      if (name == look.name) return &look;
    return nullptr;
  }

  const std::shared_ptr<const SurfacePaint>& paint_of(const SurfaceAppearance& look) {
    auto& paint = paints_[look.name];
    if (!paint) paint = std::make_shared<const SurfacePaint>(draw(look, patterns_[std::size_t(look.pattern)]));
    return paint;
  }

  std::vector<PatternImage> patterns_;
  std::map<std::string, std::shared_ptr<const SurfacePaint>> paints_;
};

}  // namespace

void add_look_pictures(PileModel& model, int threads) {
  Painter painter(threads);
  std::vector<bool> wanted(model.types.size(), false);
  for (const PileModel::Piece& piece : model.pieces)
    if (piece.number < kFirstFineHeap || piece.number >= kFirstSurrounding) wanted[piece.type] = true;
  for (std::size_t i = 0; i < model.types.size(); ++i) {
    if (!wanted[i]) continue;
    if (auto painted = painter.paint(*model.types[i].mesh)) {
      model.types[i].mesh = painted.get();
      model.kept.push_back(std::move(painted));
    }
  }
}

}  // namespace rubble
