#include "render/view/lit_scene.h"

#include <algorithm>

#include "kernel/base/disk_cache.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

float most_gloss(const PreparedScene& scene) {
  float most = 0;
  for (const PreparedMesh& mesh : scene.meshes)
    for (const PreparedTriangle& t : mesh.triangles)
      most = std::max(most, all_surface_appearances()[t.material].gloss);
  return most;
}

}  // namespace

LitScene::LitScene(GlContext& c, const Scene& s, const RenderOptions& o,
                   const std::function<void(double)>& progress)
    : context(c),
      gl(c.gl()),
      options(o),
      scene(prepare_scene(s, o.threads)),
      ground_map(make_ground_map(scene)),
      moving(s, scene),
      light(make_lights(s)),
      medium(s.air, s.seed),
      start_ns(s.start_ns),
      seed(s.seed) {
  progress(0.05);
  BakedScene baked = bake([&](double f) { progress(0.05 + 0.9 * f); });
  air_light = std::move(baked.air);
  geometry = upload_geometry(gl, scene, baked.vertices);
  if (moving.any())
    live_light = std::make_unique<LiveLight>(scene, light, std::move(baked.vertices), o.threads);
  shadow = std::make_unique<ShadowPass>(gl, scene, geometry, light, o.shadow_size);
  shadow->draw_moving();  // nothing yet
  frame_light = {&light, &shadow->map(), s.lamp, medium.clear(), s.wetness, most_gloss(scene)};
  progress(1);
}

// What rests. Of a still scene that is all of it.
BakedScene LitScene::bake(const std::function<void(double)>& progress) {
  std::vector<std::uint32_t> first_light;  // in the whole scene, of each piece that rests
  const PreparedScene resting = moving.any() ? resting_part(scene, first_light) : PreparedScene();
  const PreparedScene& part = moving.any() ? resting : scene;
  BakedScene baked;
  if (options.bake && !is_traced()) {
    BakeOptions bake;
    bake.threads = options.threads;
    bake.rays = options.bake_rays;
    bake.seed = seed;
    baked = bake_light_once(DiskCache(options.cache_folder), part, light, bake, progress);
  } else {
    baked = open_sky_light(part, light);
  }
  if (!moving.any()) return baked;
  std::vector<BakedLight> vertices(scene.light_vertices);
  for (std::size_t i = 0; i < part.placed.size(); ++i) {
    const std::size_t count = part.meshes[part.placed[i].mesh].vertices.size();
    std::copy_n(baked.vertices.begin() + part.placed[i].first_light, count,
                vertices.begin() + first_light[i]);
  }
  baked.vertices = std::move(vertices);
  return baked;
}

void LitScene::move_to(std::int64_t stamp_ns) {
  if (!moving.move_to(stamp_ns)) return;
  update_poses(gl, scene, geometry);
  if (is_traced()) return;  // the path tracer follows the scene itself
  update_light(gl, geometry, live_light->update());
  shadow->draw_moving();
}

Air LitScene::air_at(std::int64_t stamp_ns) const {
  return medium.at(double(stamp_ns - start_ns) * 1e-9);
}

void LitScene::change(const LampSpec& lamp, const AirSpec& air) {
  medium = Medium(air, seed);
  frame_light.lamp = lamp;
  frame_light.clear_air = medium.clear();
}

}  // namespace rubble
