#include "tests/render/traced_world.h"

#include <algorithm>
#include <utility>

namespace rubble::testing {

namespace {

class MadeSurfaces : public SurfaceModel {
 public:
  MadeSurfaces(const PreparedScene& scene, FindSurface find) : scene_(scene), find_(std::move(find)) {}

  void find(const SurfaceQuery& query, SurfacePoint& out) const override {
    const PlacedMesh& piece = scene_.placed[query.triangle.placed];
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    Vec3 p[3];
    for (std::size_t i = 0; i < 3; ++i)
      p[i] = piece.world_from_mesh *
             Vec3(mesh.vertices[mesh.triangles[query.triangle.source].vertices[i]].position);
    out = SurfacePoint();
    out.position = Vec3f(p[0] + (p[1] - p[0]) * double(query.u) + (p[2] - p[0]) * double(query.v));
    out.face_normal = out.normal = Vec3f(normalized(cross(p[1] - p[0], p[2] - p[0])));
    find_(piece.id, query, out);
  }

 private:
  const PreparedScene& scene_;
  FindSurface find_;
};

}  // namespace

TracedWorld::TracedWorld(const Scene& scene, FindSurface find)
    : scene_(prepare_scene(scene, 1)),
      rays_(std::make_unique<RayScene>(scene_, RayScene::Detail::finest)),
      surfaces_(std::make_shared<MadeSurfaces>(scene_, std::move(find))) {
  LightModel none;
  none.type = LightType::point;
  lights.lights.push_back(none);
  set_even_sky(lights, 0);
}

TracedImage TracedWorld::trace(const Pose& world_from_camera, const Intrinsics& k,
                               const TraceOptions& options, int tile) const {
  const SceneLights scene_lights(lights);
  const PathTracer tracer({*rays_, *surfaces_, scene_lights, air}, options);
  const TracedView view{{0, k, world_from_camera}, {lamp}};
  std::vector<PixelSums> sums(std::size_t(k.width) * std::size_t(k.height)), part;
  for (int y = 0; y < k.height; y += tile) {
    for (int x = 0; x < k.width; x += tile) {
      const PixelBox box{x, y, std::min(tile, k.width - x), std::min(tile, k.height - y)};
      tracer.trace(view, box, part);
      for (int i = 0; i < box.width * box.height; ++i)
        sums[std::size_t((y + i / box.width) * k.width + x + i % box.width)] = part[std::size_t(i)];
    }
  }
  return average_samples(sums, k.width, k.height, options.samples);
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
