#include "render/geometry/ray_scene.h"

#include "kernel/base/error.h"
#include "render/geometry/ray_scene_embree.h"

namespace rubble {

RayScene::RayScene(const PreparedScene& scene, Detail detail)
    : embree_(std::make_unique<Embree>()) {
  // One thread builds: the tree, and with it the choice among equal hits, is then always the same.
  embree_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (!embree_->device) throw RunError("cannot cast rays: Embree gives no device");
  embree_->scene = rtcNewScene(embree_->device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    const PlacedMesh& piece = scene.placed[i];
    const PreparedMesh& mesh = scene.meshes[piece.mesh];
    const PreparedLevel& level = detail == Detail::finest ? mesh.levels.front() : mesh.levels.back();
    const std::uint32_t base = std::uint32_t(positions.size());
    for (const PreparedVertex& v : mesh.vertices)
      positions.push_back(Vec3f(piece.world_from_mesh * (Vec3(v.position) * piece.scale)));
    for (std::uint32_t t = 0; t < level.triangle_count; ++t) {
      triangles_.push_back({i, level.first_triangle + t});
      for (std::uint32_t v : mesh.triangles[level.first_triangle + t].vertices)
        indices.push_back(base + v);
    }
  }
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertex_memory = rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), positions.size() + 1);
  void* index_memory = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                               3 * sizeof(std::uint32_t), triangles_.size());
  if (!triangles_.empty() && (!vertex_memory || !index_memory))
    throw RunError("cannot cast rays: out of memory for " + std::to_string(triangles_.size()) +
                   " triangles");
  std::copy(positions.begin(), positions.end(), static_cast<Vec3f*>(vertex_memory));
  std::copy(indices.begin(), indices.end(), static_cast<std::uint32_t*>(index_memory));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
  if (rtcGetDeviceError(embree_->device) != RTC_ERROR_NONE)
    throw RunError("cannot cast rays: Embree reports an error while building its tree");
}

RayScene::~RayScene() = default;

RayScene::Hit RayScene::cast(const Vec3f& from, const Vec3f& d, float nearest,
                             float farthest) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = {from.x, from.y, from.z, nearest, d.x, d.y, d.z, 0, farthest, 0xffffffffu, 0, 0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const Vec3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  return {query.hit.primID, query.ray.tfar, dot(normal, d) > 0};
}

bool RayScene::blocked(const Vec3f& from, const Vec3f& d, float nearest, float farthest) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = {from.x, from.y, from.z, nearest, d.x, d.y, d.z, 0, farthest, 0xffffffffu, 0, 0};
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace rubble
