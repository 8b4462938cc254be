// Baked light by way of the disk cache.
#include "render/lighting/bake.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

constexpr int kVersion = 4;  // raise it when the same scene bakes to other light

template <typename T>
void add_vec(CacheKey& key, const Vec3T<T>& v) {
  key.add(v.x).add(v.y).add(v.z);
}

void add_mesh(CacheKey& key, const PreparedMesh& mesh) {
  key.add(mesh.vertices.size()).add(mesh.triangles.size()).add(mesh.bake_points.size());
  for (const PreparedVertex& v : mesh.vertices) {
    add_vec(key, v.position);
    key.add_bytes(v.bake_points.data(), sizeof v.bake_points);
    key.add_bytes(v.bake_weights.data(), sizeof v.bake_weights);
  }
  for (const PreparedTriangle& t : mesh.triangles)
    key.add_bytes(t.vertices.data(), sizeof t.vertices).add(t.material);
  for (const BakePoint& p : mesh.bake_points) add_vec(key, p.position), add_vec(key, p.normal);
}

void add_placed(CacheKey& key, const PlacedMesh& piece) {
  const Quat& q = piece.world_from_mesh.rotation;
  key.add(piece.mesh).add(piece.scale).add(q.w).add(q.x).add(q.y).add(q.z).add(piece.id);
  add_vec(key, piece.world_from_mesh.translation);
}

void add_light(CacheKey& key, const LightSet& light) {
  key.add(light.lights.size());
  for (const LightModel& l : light.lights) {
    key.add(l.type).add(l.cos_outer).add(l.cos_inner);
    for (const Vec3f& v : {l.position, l.axis, l.colour}) add_vec(key, v);
  }
  for (const Vec3f& v : light.sky.map) add_vec(key, v);
}

std::string key_of(const PreparedScene& scene, const LightSet& light,
                   const BakeOptions& options) {
  CacheKey key("bake_light", kVersion);
  key.add(options.rays).add(options.bounces).add(options.seed);
  for (const PreparedMesh& mesh : scene.meshes) add_mesh(key, mesh);
  key.add(scene.placed.size());
  for (const PlacedMesh& piece : scene.placed) add_placed(key, piece);
  add_light(key, light);
  for (const SurfaceAppearance& look : all_surface_appearances())
    add_vec(key, look.dark), add_vec(key, look.light), add_vec(key, look.accent);
  return key.hex();
}

}  // namespace

BakedScene bake_light_once(const DiskCache& cache, const PreparedScene& scene,
                           const LightSet& light, const BakeOptions& options,
                           const std::function<void(double)>& progress) {
  if (cache.folder().empty()) return bake_light(scene, light, options, progress);
  const std::string key = key_of(scene, light, options);
  if (const auto bytes = cache.find("baked_light", key)) {
    BakedScene out;
    CacheReader reader(*bytes);
    reader.get(out.vertices), reader.get(out.air.origin), reader.get(out.air.cell);
    reader.get(out.air.size), reader.get(out.air.radiance), reader.get(out.air.direct);
    if (reader.whole() && out.vertices.size() == scene.light_vertices) return out;
  }
  const BakedScene out = bake_light(scene, light, options, progress);
  CacheWriter writer;
  writer.put(out.vertices), writer.put(out.air.origin), writer.put(out.air.cell);
  writer.put(out.air.size), writer.put(out.air.radiance), writer.put(out.air.direct);
  cache.store("baked_light", key, writer.bytes());
  return out;
}

}  // namespace rubble
