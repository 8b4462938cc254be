// What a bake follows from.
#include "render/lighting/bake.h"

namespace rubble {

namespace {

constexpr int kVersion = 13;  // raise it when the same scene bakes to other light

template <typename T>
void add_vec(CacheKey& key, const Vec3T<T>& v) {
  key.add(v.x).add(v.y).add(v.z);
}

void add_mesh(CacheKey& key, const PreparedMesh& mesh) {
  key.add(mesh.vertices.size()).add(mesh.triangles.size()).add(mesh.bake_points.size());
  for (const PreparedVertex& v : mesh.vertices) add_vec(key, v.position), add_vec(key, v.normal);
  for (const PreparedTriangle& t : mesh.triangles)
    key.add_bytes(t.vertices.data(), sizeof t.vertices).add(t.material).add(t.light_steps).add(t.first_node);
  for (const LightNode& node : mesh.light_nodes) {
    key.add_bytes(node.points.data(), sizeof node.points);
    key.add_bytes(node.weights.data(), sizeof node.weights);
  }
  for (const BakePoint& p : mesh.bake_points)
    add_vec(key, p.position), add_vec(key, p.normal), key.add(p.first_origin).add(p.origin_count);
  for (const BakeOrigin& o : mesh.bake_origins) add_vec(key, o.position), add_vec(key, o.normal);
}

void add_placed(CacheKey& key, const PlacedMesh& piece) {
  const Quat& q = piece.world_from_mesh.rotation;
  key.add(piece.mesh).add(piece.scale).add(q.w).add(q.x).add(q.y).add(q.z).add(piece.id);
  key.add(piece.look_seed[0]).add(piece.look_seed[1]);
  add_vec(key, piece.world_from_mesh.translation);
}

void add_light(CacheKey& key, const LightSet& light) {
  key.add(light.lights.size());
  for (const LightModel& l : light.lights) {
    key.add(l.type).add(l.cos_outer).add(l.cos_inner);
    for (const Vec3f& v : {l.position, l.axis, l.colour}) add_vec(key, v);
  }
  for (const LightModel& l : light.far) {
    key.add(l.type).add(l.cos_outer).add(l.cos_inner);
    for (const Vec3f& v : {l.position, l.axis, l.colour}) add_vec(key, v);
  }
  for (const Vec3f& v : light.sky.map) add_vec(key, v);
}

}  // namespace

std::string bake_key(const PreparedScene& scene, const LightSet& light, const std::string& surfaces,
                     const BakeOptions& options) {
  CacheKey key("bake_light", kVersion);
  key.add_text(surfaces);
  key.add(options.rays).add(options.bounces).add(options.seed);
  for (const PreparedMesh& mesh : scene.meshes) add_mesh(key, mesh);
  key.add(scene.placed.size());
  for (const PlacedMesh& piece : scene.placed) add_placed(key, piece);
  if (scene.glass) key.add_text("light passes through glass");
  add_light(key, light);
  return key.hex();
}

}  // namespace rubble
