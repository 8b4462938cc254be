#include "tests/render/traced_world.h"

#include <algorithm>
#include <utility>

namespace rubble::testing {

namespace {

class MadeSurfaces : public SurfaceModel {
 public:
  MadeSurfaces(const PreparedScene& scene, FindSurface find) : scene_(scene), find_(std::move(find)) {}

  void find(const SurfaceQuery& query, SurfacePoint& out) const override {
    out = find_flat_point(scene_, query);
    find_(scene_.placed[query.triangle.placed].id, query, out);
  }

 private:
  const PreparedScene& scene_;
  FindSurface find_;
};

}  // namespace

TracedWorld::TracedWorld(const Scene& scene, FindSurface find)
    : scene_(prepare_scene(scene, 1)),
      rays_(std::make_unique<RayScene>(scene_, RayScene::Detail::finest, RayScene::Part::solid)),
      sheets_(std::make_unique<GlassSheets>(scene_)),
      surfaces_(std::make_shared<MadeSurfaces>(scene_, std::move(find))) {
  LightModel none;
  none.type = LightType::point;
  lights.lights.push_back(none);
  set_even_sky(lights, 0);
}

TracedImage TracedWorld::trace(const Pose& world_from_camera, const Intrinsics& k,
                               const TraceOptions& options, int tile) const {
  const SceneLights scene_lights(lights);
  const PathTracer tracer({*rays_, *surfaces_, scene_lights, air, false, sheets_.get()}, options);
  const TracedView view{{0, k, world_from_camera}, {lamp}};
  return trace_image(tracer, view, options.samples, {tile, 1});
}

void set_even_sky(LightSet& lights, float radiance) {
  lights.sky.map.assign(std::size_t(Sky::kSide) * Sky::kSide, Vec3f(1, 1, 1) * radiance);
  lights.sky.mean = Vec3f(1, 1, 1) * radiance;
}

TriangleMesh make_plate(double side) {
  TriangleMesh mesh;
  mesh.surface_names = {"plaster"};
  const float h = float(side / 2);
  mesh.positions = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.surfaces = {0, 0};
  return mesh;
}

TriangleMesh make_pane(const Vec3& size) {
  TriangleMesh mesh = make_box(size);
  mesh.surface_names = {"glass"};
  std::fill(mesh.surfaces.begin(), mesh.surfaces.end(), 0);
  return mesh;
}

TriangleMesh make_room(const Vec3& size) {
  TriangleMesh mesh = make_box(size);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

double mean_green(const TracedImage& image) {
  double sum = 0;
  for (const Vec3f& light : image.light) sum += double(light.y);
  return sum / double(image.size());
}

}  // namespace rubble::testing
