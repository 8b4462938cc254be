#include "render/lighting/bake.h"

#include "kernel/base/portable_math.h"
#include "render/lighting/bake_air.h"
#include "render/lighting/baker.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

BakedScene open_sky_light(const PreparedScene& scene, const LightSet& light) {
  // An even dome gives pi L to a level face, half that to a wall.
  const Vec3f radiance = light.sky.mean;
  BakedScene out;
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

BakedScene bake_light(const PreparedScene& scene, SceneRays& rays, const LightSet& light, const AlbedoAt& albedo,
                      const BakeOptions& options, const std::function<void(double)>& progress) {
  Baker baker(scene, rays.solid(), light, albedo, options);
  baker.run(progress);
  const std::vector<Vec3f> radiance = baker.triangle_radiance();
  BakedScene out{baker.node_light(), bake_air({scene, light, baker.rays(), radiance, options.threads}), baker.links()};
  if (progress) progress(1);
  return out;
}

}  // namespace rubble
