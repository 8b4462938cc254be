#include "render/lighting/bake.h"

#include <algorithm>
#include <exception>
#include <numeric>

#include "kernel/base/portable_math.h"
#include "render/lighting/bake_air.h"
#include "render/lighting/baker.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

OpenSkyLight open_sky_light(const PreparedScene& scene, const LightSet& light) {
  // An even dome gives pi L to a level face, half that to a wall.
  const Vec3f radiance = light.sky.mean;
  OpenSkyLight out;
  out.air.size = {1, 1, 1};
  out.air.radiance = {radiance * 0.5f};
  out.nodes.reserve(scene.light_nodes);
  for (const PlacedMesh& piece : scene.placed) {
    for (const LightNode& node : scene.meshes[piece.mesh].light_nodes) {
      const Vec3f n(piece.world_from_mesh.rotation.rotate(Vec3(node.normal)));
      const float e = portable::kPiF * luminance(radiance) * (0.55f + 0.45f * n.z);
      out.nodes.push_back(pack_light(n * e, radiance));
    }
  }
  return out;
}

LightBake::LightBake(const PreparedScene& scene, SceneRays& rays, const LightSet& light, const AlbedoAt& albedo,
                     const BakeOptions& options, const DiskCache& cache, const std::string& surfaces,
                     const std::function<void(double)>& progress)
    : scene_(scene),
      rays_(rays),
      light_(light),
      options_(options),
      cache_(cache),
      baker_(std::make_unique<Baker>(scene, rays, light, options)),
      nodes_(scene.light_nodes),
      known_(scene.placed.size(), 0) {
  if (!cache_.folder().empty()) key_ = bake_key(scene, light, surfaces, options);
  if (!restore_solution()) {
    baker_->solve(albedo, progress);
    keep_solution();
  }
  restore_pieces();
  if (progress) progress(1);
}

LightBake::~LightBake() {
  try {
    keep_pieces();
  } catch (const std::exception&) {
    // Without it the next run takes longer.
  }
}

std::vector<std::uint32_t> LightBake::light_pieces(const std::vector<std::uint32_t>& pieces) {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t piece : pieces)
    if (!known_[piece]) found.push_back(piece);
  if (found.empty()) return found;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  baker_->light_pieces(found, nodes_);
  // Only now: what fails on the way is not kept as light.
  for (const std::uint32_t piece : found) known_[piece] = 1;
  known_count_ += found.size();
  return found;
}

std::vector<std::uint32_t> LightBake::light_all() {
  std::vector<std::uint32_t> all(known_.size());
  std::iota(all.begin(), all.end(), 0u);
  return light_pieces(all);
}

const AirLight& LightBake::air() {
  if (air_) return *air_;
  const std::string kind = "baked_air";
  AirLight air;
  bool kept = false;
  if (const auto bytes = cache_.find(kind, key_)) {
    CacheReader from(*bytes);
    from.get(air.origin), from.get(air.cell), from.get(air.size), from.get(air.radiance), from.get(air.direct);
    kept = from.whole();
  }
  if (!kept) {
    const RayScene& rays = rays_.solid();
    air = bake_air({scene_, light_, rays,
                    [&](std::uint32_t triangle) { return baker_->triangle_radiance(rays.triangle(triangle)); },
                    options_.threads});
    cache_.store(kind, key_, [&air](CacheWriter& to) {
      to.put(air.origin), to.put(air.cell), to.put(air.size), to.put(air.radiance), to.put(air.direct);
    });
  }
  air_ = std::make_unique<AirLight>(std::move(air));
  return *air_;
}

BakeLinks LightBake::links() const { return baker_->links(); }

const std::vector<Vec3f>& LightBake::radiance() const { return baker_->radiance(); }

bool LightBake::restore_solution() {
  const auto bytes = cache_.find("light_solution", key_);
  if (!bytes) return false;
  CacheReader from(*bytes);
  return baker_->restore(from);
}

void LightBake::keep_solution() const {
  cache_.store("light_solution", key_, [this](CacheWriter& to) { baker_->save(to); });
}

// Their numbers, then their nodes one after the other.
void LightBake::restore_pieces() {
  const auto bytes = cache_.find("lit_pieces", key_);
  if (!bytes) return;
  std::vector<std::uint32_t> pieces;
  std::vector<BakedLight> light;
  CacheReader from(*bytes);
  from.get(pieces), from.get(light);
  std::size_t count = 0;
  bool whole = from.whole();
  for (const std::uint32_t piece : pieces) {
    whole = whole && piece < known_.size();
    if (whole) count += node_count(piece);
  }
  if (!whole || count != light.size()) return;
  std::size_t at = 0;
  for (const std::uint32_t piece : pieces) {
    std::copy_n(light.begin() + std::ptrdiff_t(at), node_count(piece), nodes_.begin() + scene_.placed[piece].first_light);
    at += node_count(piece);
    known_[piece] = 1;
  }
  known_count_ = kept_count_ = pieces.size();
}

void LightBake::keep_pieces() const {
  if (cache_.folder().empty() || known_count_ == kept_count_) return;
  std::vector<std::uint32_t> pieces;
  std::uint64_t count = 0;
  for (std::uint32_t piece = 0; piece < known_.size(); ++piece) {
    if (!known_[piece]) continue;
    pieces.push_back(piece);
    count += node_count(piece);
  }
  cache_.store("lit_pieces", key_, [&](CacheWriter& to) {
    to.put(pieces), to.put(count);
    for (const std::uint32_t piece : pieces) to.put_values(nodes_.data() + scene_.placed[piece].first_light, node_count(piece));
  });
}

std::size_t LightBake::node_count(std::uint32_t piece) const {
  return scene_.meshes[scene_.placed[piece].mesh].light_nodes.size();
}

}  // namespace rubble
