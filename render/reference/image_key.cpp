#include "render/reference/image_key.h"

#include "kernel/base/system/disk_cache.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

constexpr int kVersion = 2;       // raise it when the same scene gives another image,
constexpr int kGlassVersion = 1;  // or this when one with glass does

template <typename T>
void add_vec(CacheKey& key, const Vec3T<T>& v) {
  key.add(v.x).add(v.y).add(v.z);
}

void add_pose(CacheKey& key, const Pose& pose) {
  key.add(pose.rotation.w).add(pose.rotation.x).add(pose.rotation.y).add(pose.rotation.z);
  add_vec(key, pose.translation);
}

void add_mesh(CacheKey& key, const PreparedMesh& mesh) {
  const PreparedLevel& level = mesh.levels.front();
  key.add(mesh.vertices.size()).add(level.triangle_count);
  for (const PreparedVertex& v : mesh.vertices) add_vec(key, v.position), add_vec(key, v.normal);
  for (std::uint32_t t = 0; t < level.triangle_count; ++t) {
    const PreparedTriangle& triangle = mesh.triangles[level.first_triangle + t];
    key.add_bytes(triangle.vertices.data(), sizeof triangle.vertices).add(triangle.material);
  }
  for (const TrianglePaint& paint : mesh.paint) {
    key.add(paint.paint);
    for (const PaintCorner& c : paint.corners) key.add(c.u).add(c.v), add_vec(key, c.colour);
  }
}

void add_light(CacheKey& key, const LightModel& l) {
  key.add(l.type).add(l.cos_outer).add(l.cos_inner);
  for (const Vec3f& v : {l.position, l.axis, l.colour}) add_vec(key, v);
}

void add_lights(CacheKey& key, const LightSet& set) {
  key.add(set.lights.size());
  // Of carried ones image_key() knows where they are.
  for (std::size_t i = 0; i < set.first_carried(); ++i) add_light(key, set.lights[i]);
  for (const LightModel& l : set.far) add_light(key, l);
  for (const Vec3f& v : set.sky.map) add_vec(key, v);
  add_vec(key, set.sky.sun_radiance);
}

void add_look(CacheKey& key, const SurfaceAppearance& look) {
  for (const Vec3f& v : {look.dark, look.light, look.accent}) add_vec(key, v);
  for (const float f : {look.tile, look.bump, look.dust, look.variation, look.reflectance, look.roughness, look.glow})
    key.add(f);
}

}  // namespace

std::string surroundings_key(const ReferenceSurroundings& s) {
  CacheKey key("reference_scene", kVersion);
  for (const PreparedMesh& mesh : s.scene.meshes) add_mesh(key, mesh);
  for (const PlacedMesh& piece : s.scene.placed) {
    key.add(piece.mesh).add(piece.scale).add(piece.look_seed[0]).add(piece.look_seed[1]);
    key.add(piece.moves);
    if (!piece.moves) add_pose(key, piece.world_from_mesh);  // or by image_key()
  }
  key.add_bytes(s.ground.texels.data(), s.ground.texels.size());
  add_lights(key, s.lights);
  for (const PatternImage& p : s.patterns) key.add_bytes(p.texels.data(), p.texels.size());
  for (const SurfaceAppearance& look : all_surface_appearances()) add_look(key, look);
  key.add(s.wetness).add_text(s.scene.paint_key);
  if (s.scene.glass) key.add(kGlassVersion);
  return key.hex();
}

std::string image_key(const std::string& surroundings, const PreparedScene& scene,
                      const LightSet& lights, const ReferenceOptions& options, const ViewRays& view,
                      const LampSpec& lamp, const Air& air) {
  CacheKey key("reference_image", kVersion);
  for (std::size_t i = lights.first_carried(); i < lights.lights.size(); ++i) add_light(key, lights.lights[i]);
  for (const PlacedMesh& piece : scene.placed) {
    if (!piece.moves) continue;
    key.add(piece.there);
    add_pose(key, piece.world_from_mesh);
  }
  key.add_text(surroundings).add(options.samples).add(options.denoise).add(options.jitter);
  key.add(options.seed).add(view.stamp_ns);
  const Intrinsics& k = view.intrinsics;
  key.add(k.width).add(k.height).add(k.fx).add(k.fy).add(k.cx).add(k.cy);
  add_pose(key, view.world_from_camera);
  if (view.world_from_rig) add_pose(key, *view.world_from_rig);
  for (const Pose& pose : view.row_poses) add_pose(key, pose);
  if (view.directions)
    key.add_bytes(view.directions->data(), view.directions->size() * sizeof(Vec3f));
  key.add(lamp.on).add(lamp.intensity_cd).add(lamp.cone_deg).add(lamp.shape).add(lamp.size);
  add_vec(key, lamp.position);
  key.add(air.albedo()).add(air.fog_asymmetry()).add(air.dust_asymmetry());
  for (const Precipitation& kind : air.falling()) key.add(kind.kind()).add(kind.extinction());
  // The fog's law by some of its values: it has no other face.
  for (int i = 0; i < 64; ++i) {
    const Vec3 p(0.37 * (i % 7) - 1, 0.41 * (i % 5) - 1, 0.29 * (i % 11));
    key.add(air.fog(p)).add(air.billows(p));
  }
  for (const DustPuff& puff : air.puffs()) {
    add_vec(key, puff.centre);
    key.add(puff.deviation).add(puff.extinction);
  }
  return key.hex();
}

}  // namespace rubble
