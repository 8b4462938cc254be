#include "render/geometry/ray_scene.h"

#include <algorithm>

#include "render/geometry/ray_scene_embree.h"
#include "render/materials/glass.h"

namespace rubble {

namespace {

constexpr unsigned kResting = EmbreeTree::kResting;

void place(RTCGeometry instance, const float (&columns)[12]) {
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

}  // namespace

RayScene::RayScene(const PreparedScene& scene, Detail detail, Part part)
    : scene_(scene), detail_(detail), part_(part), embree_(std::make_unique<Embree>()) {
  add_resting();
  add_moving();
  embree_->commit();
  moment_ = scene.moment;
}

RayScene::~RayScene() = default;

const PreparedLevel& RayScene::level_of(const PreparedMesh& mesh) const {
  return detail_ == Detail::finest ? mesh.levels.front() : mesh.levels.back();
}

bool RayScene::has(const PreparedTriangle& triangle) const {
  return part_ == Part::all || (triangle.material == glass_appearance()) == (part_ == Part::glass);
}

void RayScene::add_resting() {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;
  std::size_t vertices = 0, triangles = 0;
  for (const PlacedMesh& piece : scene_.placed) {
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    if (part_ == Part::glass && !mesh.glass) continue;
    triangles += level_of(mesh).triangle_count;
    if (!piece.moves) vertices += mesh.vertices.size();
  }
  positions.reserve(vertices), indices.reserve(3 * triangles), triangles_.reserve(triangles);
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (piece.moves) continue;
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    if (part_ == Part::glass && !mesh.glass) continue;
    const PreparedLevel& level = level_of(mesh);
    const std::uint32_t base = std::uint32_t(positions.size());
    for (const PreparedVertex& v : mesh.vertices)
      positions.push_back(Vec3f(piece.world_from_mesh * (Vec3(v.position) * piece.scale)));
    for (std::uint32_t t = 0; t < level.triangle_count; ++t) {
      if (!has(mesh.triangles[level.first_triangle + t])) continue;
      triangles_.push_back({i, level.first_triangle + t});
      for (std::uint32_t v : mesh.triangles[level.first_triangle + t].vertices)
        indices.push_back(base + v);
    }
  }
  const bool alone = std::none_of(scene_.placed.begin(), scene_.placed.end(), [](const PlacedMesh& p) { return p.moves; });
  if (alone) return embree_->attach(embree_->scene, positions, indices.data(), indices.size() / 3);
  embree_->resting = embree_->new_scene();
  embree_->attach(embree_->resting, positions, indices.data(), indices.size() / 3);
  rtcCommitScene(embree_->resting);
  constexpr float kIdentity[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const RTCGeometry instance = embree_->attach_instance(embree_->resting, kResting);
  rubble::place(instance, kIdentity);
  rtcCommitGeometry(instance);
}

void* RayScene::mesh_scene(std::uint32_t mesh) {
  RTCScene& of_mesh = embree_->meshes[mesh];
  if (of_mesh) return of_mesh;
  of_mesh = embree_->new_scene();
  const PreparedMesh& prepared = scene_.meshes[mesh];
  const PreparedLevel& level = level_of(prepared);
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;
  for (const PreparedVertex& v : prepared.vertices) positions.push_back(v.position);
  for (std::uint32_t t = 0; t < level.triangle_count; ++t) {
    const PreparedTriangle& triangle = prepared.triangles[level.first_triangle + t];
    if (has(triangle)) indices.insert(indices.end(), triangle.vertices.begin(), triangle.vertices.end());
  }
  embree_->attach(of_mesh, positions, indices.data(), indices.size() / 3);
  rtcCommitScene(of_mesh);
  return of_mesh;
}

void RayScene::add_moving() {
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    if (!piece.moves || (part_ == Part::glass && !mesh.glass)) continue;
    Mover mover;
    mover.placed = i;
    mover.first_triangle = std::uint32_t(triangles_.size());
    const PreparedLevel& level = level_of(mesh);
    for (std::uint32_t t = 0; t < level.triangle_count; ++t)
      if (has(mesh.triangles[level.first_triangle + t])) triangles_.push_back({i, level.first_triangle + t});
    // Its number there: one more than its index among the movers.
    mover.geometry = embree_->attach_instance(static_cast<RTCScene>(mesh_scene(piece.mesh)),
                                              kResting + 1 + unsigned(movers_.size()));
    place(mover);
    movers_.push_back(mover);
  }
}

void RayScene::place(const Mover& mover) {
  const PlacedMesh& piece = scene_.placed[mover.placed];
  const Mat3 turn = piece.world_from_mesh.rotation.matrix() * piece.scale;
  float columns[12];
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) columns[c * 3 + r] = float(turn.rows[std::size_t(r)][c]);
  for (int r = 0; r < 3; ++r) columns[9 + r] = float(piece.world_from_mesh.translation[r]);
  rubble::place(mover.geometry, columns);
  if (piece.there)
    rtcEnableGeometry(mover.geometry);
  else
    rtcDisableGeometry(mover.geometry);
  rtcCommitGeometry(mover.geometry);
}

void RayScene::follow() {
  if (moment_ == scene_.moment) return;
  moment_ = scene_.moment;
  for (const Mover& mover : movers_) place(mover);
  embree_->commit();
}

RayScene::Met RayScene::met_by(std::uint32_t primitive, std::uint32_t instance,
                               const Vec3f& normal) const {
  if (instance == RTC_INVALID_GEOMETRY_ID || instance == kResting) return {primitive, normal};
  const Mover& mover = movers_[instance - kResting - 1];
  // Embree gives the normal in the frame of the mesh.
  return {primitive + mover.first_triangle,
          Vec3f(scene_.placed[mover.placed].world_from_mesh.rotation.rotate(Vec3(normal)))};
}

RayScene::Hit RayScene::cast(const Vec3f& from, const Vec3f& d, float nearest,
                             float farthest) const {
  EmbreeRayContext context;
  RTCRayHit query{};
  query.ray = {from.x, from.y, from.z, nearest, d.x, d.y, d.z, 0, farthest, 0xffffffffu, 0, 0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_intersect(embree_->scene, query, context);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const Met met = met_by(query.hit.primID, query.hit.instID[0],
                         {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
  return {met.triangle, query.ray.tfar, dot(met.normal, d) > 0};
}

bool RayScene::blocked(const Vec3f& from, const Vec3f& d, float nearest, float farthest) const {
  EmbreeRayContext context;
  RTCRay ray = {from.x, from.y, from.z, nearest, d.x, d.y, d.z, 0, farthest, 0xffffffffu, 0, 0};
  embree_occlude(embree_->scene, ray, context);
  return ray.tfar < 0;
}

}  // namespace rubble
