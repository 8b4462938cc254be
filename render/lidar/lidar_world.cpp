#include "render/lidar/lidar_world.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/geometry/embree_tree.h"
#include "render/materials/paint_layers.h"
#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

constexpr unsigned kResting = EmbreeTree::kResting;

RTCQuaternionDecomposition decompose(const Pose& pose, float scale) {
  RTCQuaternionDecomposition d;
  rtcInitQuaternionDecomposition(&d);
  rtcQuaternionDecompositionSetScale(&d, scale, scale, scale);
  const Quat& q = pose.rotation;
  rtcQuaternionDecompositionSetQuaternion(&d, float(q.w), float(q.x), float(q.y), float(q.z));
  const Vec3& t = pose.translation;
  rtcQuaternionDecompositionSetTranslation(&d, float(t.x), float(t.y), float(t.z));
  return d;
}

}  // namespace

struct LidarWorld::Tree : EmbreeTree {
  struct Mover {
    RTCGeometry geometry = nullptr;  // owned by the tree
    std::uint32_t mesh = 0;
    float scale = 1;
    Quat rotation;  // at the first time of the span
    std::int32_t piece = -1;
  };

  std::map<std::uint32_t, std::vector<std::uint16_t>> mesh_looks;  // of those that move, as looks_of()
  std::vector<std::uint16_t> resting_looks;
  std::vector<float> paint_reds;  // mean red albedo of painted surfaces
  std::map<const TriangleMesh*, std::vector<std::uint16_t>> known_looks;  // by looks_of()
  std::vector<std::uint32_t> resting_ends;   // of each instance that rests, one past its last triangle
  std::vector<std::int32_t> resting_pieces;  // its id
  std::vector<Mover> movers;
  SceneMotion motion;
  bool ground = true;

  void attach(RTCScene to, const std::vector<Vec3f>& positions,
              const std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    static_assert(sizeof(triangles.front()) == 3 * sizeof(std::uint32_t));
    EmbreeTree::attach(to, positions, triangles.empty() ? nullptr : triangles.front().data(), triangles.size());
  }
  const std::vector<std::uint16_t>& looks_of(const TriangleMesh& mesh);
  void add_resting(const Scene& from);
  void add_movers(const Scene& from);
  void intersect(const Ray* rays, std::size_t count, double max_distance, RTCRayHit8& query) const;
  std::int32_t piece_of(unsigned primitive, unsigned instance) const;
  Hit read(unsigned primitive, unsigned instance, const Vec3f& normal, const Ray& ray, double t) const;
  // Where a ray that has met something at `before` (negative: nothing) meets the ground first; negative: it does not.
  double meet_ground(const Ray& ray, double max_distance, double before) const {
    if (!ground || ray.direction.z >= 0 || ray.from.z <= 0) return -1;
    const double t = -ray.from.z / ray.direction.z;
    return t > max_distance || (before >= 0 && before <= t) ? -1 : t;
  }
};

void LidarWorld::Tree::add_resting(const Scene& from) {
  std::vector<std::uint8_t> moves(from.instances.size(), 0);
  for (const std::uint32_t i : from.motion.moving) moves.at(i) = 1;
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < from.instances.size(); ++i) {
    if (moves[i]) continue;
    const SceneInstance& piece = from.instances[i];
    const TriangleMesh& mesh = from.meshes.at(piece.mesh)->levels.front();
    const auto base = std::uint32_t(positions.size());
    for (const Vec3f& p : mesh.positions)
      positions.push_back(Vec3f(piece.world_from_body * (Vec3(p) * double(piece.scale))));
    for (const auto& t : mesh.triangles) triangles.push_back({base + t[0], base + t[1], base + t[2]});
    const std::vector<std::uint16_t>& looks = looks_of(mesh);
    resting_looks.insert(resting_looks.end(), looks.begin(), looks.end());
    resting_ends.push_back(std::uint32_t(triangles.size()));
    resting_pieces.push_back(std::int32_t(piece.id));
  }
  if (from.motion.moving.empty()) return attach(scene, positions, triangles);
  resting = new_scene();
  attach(resting, positions, triangles);
  rtcCommitScene(resting);
  const RTCGeometry instance = attach_instance(resting, kResting);
  const RTCQuaternionDecomposition there = decompose({}, 1);
  rtcSetGeometryTransformQuaternion(instance, 0, &there);
  rtcCommitGeometry(instance);
}

void LidarWorld::Tree::add_movers(const Scene& from) {
  for (const std::uint32_t i : from.motion.moving) {
    const SceneInstance& piece = from.instances[i];
    RTCScene& of_mesh = meshes[piece.mesh];
    if (!of_mesh) {
      const TriangleMesh& mesh = from.meshes.at(piece.mesh)->levels.front();
      of_mesh = new_scene();
      attach(of_mesh, mesh.positions, mesh.triangles);
      rtcCommitScene(of_mesh);
      mesh_looks[piece.mesh] = looks_of(mesh);
    }
    const RTCGeometry geometry = attach_instance(of_mesh, kResting + 1 + unsigned(movers.size()));
    rtcSetGeometryTimeStepCount(geometry, 2);
    const Mover mover{geometry, piece.mesh, piece.scale, {}, std::int32_t(piece.id)};
    movers.push_back(mover);
  }
}

// Of each triangle of a mesh: an index into all_surface_appearances(), after its end one into paint_reds.
const std::vector<std::uint16_t>& LidarWorld::Tree::looks_of(const TriangleMesh& mesh) {
  const auto [found, is_new] = known_looks.try_emplace(&mesh);
  if (!is_new) return found->second;
  std::vector<std::uint16_t> names;
  for (std::size_t s = 0; s < mesh.surface_names.size(); ++s) {
    if (!mesh.paint_of(s)) {
      names.push_back(std::uint16_t(find_surface_appearance(mesh.surface_names[s])));
      continue;
    }
    names.push_back(std::uint16_t(all_surface_appearances().size() + paint_reds.size()));
    paint_reds.push_back(mean_paint(mesh, s).x);
  }
  if (names.empty()) names.push_back(std::uint16_t(find_surface_appearance("concrete_cast")));
  std::vector<std::uint16_t>& looks = found->second;
  looks.assign(mesh.triangles.size(), names.front());
  for (std::size_t t = 0; t < mesh.surfaces.size(); ++t) looks[t] = names.at(mesh.surfaces[t]);
  return looks;
}

// normal: as Embree gives it, in the frame of the mesh.
LidarWorld::Hit LidarWorld::Tree::read(unsigned primitive, unsigned instance, const Vec3f& normal,
                                       const Ray& ray, double t) const {
  Vec3 out(normal);
  std::uint16_t look = 0;
  if (instance == RTC_INVALID_GEOMETRY_ID || instance == kResting) {
    look = resting_looks[primitive];
  } else {
    const Mover& mover = movers[instance - kResting - 1];
    out = mover.rotation.rotate(out);
    look = mesh_looks.at(mover.mesh)[primitive];
  }
  out = normalized(out);
  const double cosine = dot(out, ray.direction);
  const float up = float(cosine > 0 ? -out.z : out.z);
  const std::vector<SurfaceAppearance>& known = all_surface_appearances();
  const float red = look < known.size() ? mean_red_albedo(known[look], up) : paint_reds[look - known.size()];
  return {t, float(std::fabs(cosine)), red, piece_of(primitive, instance)};
}

std::int32_t LidarWorld::Tree::piece_of(unsigned primitive, unsigned instance) const {
  if (instance != RTC_INVALID_GEOMETRY_ID && instance != kResting) return movers[instance - kResting - 1].piece;
  const auto end = std::upper_bound(resting_ends.begin(), resting_ends.end(), primitive);
  return resting_pieces[std::size_t(end - resting_ends.begin())];
}

LidarWorld::LidarWorld(const Scene& from) : tree_(std::make_unique<Tree>()) {
  Tree& t = *tree_;
  t.motion = from.motion, t.ground = from.ground;
  t.add_resting(from);
  t.add_movers(from);
  if (!moves()) t.commit();
}

LidarWorld::~LidarWorld() = default;

bool LidarWorld::moves() const { return !tree_->movers.empty(); }

void LidarWorld::span(std::int64_t from_ns, std::int64_t to_ns) {
  if (!moves()) return;
  const std::vector<std::optional<Pose>> begin = tree_->motion.poses_at(from_ns),
                                         end = tree_->motion.poses_at(to_ns);
  for (std::size_t i = 0; i < tree_->movers.size(); ++i) {
    Tree::Mover& mover = tree_->movers[i];
    if (!begin[i] || !end[i]) {
      rtcDisableGeometry(mover.geometry);
      continue;
    }
    Pose last = *end[i];  // the shorter way round
    const Quat &a = begin[i]->rotation, &b = last.rotation;
    if (a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0) last.rotation = {-b.w, -b.x, -b.y, -b.z};
    const RTCQuaternionDecomposition first = decompose(*begin[i], mover.scale),
                                     second = decompose(last, mover.scale);
    rtcSetGeometryTransformQuaternion(mover.geometry, 0, &first);
    rtcSetGeometryTransformQuaternion(mover.geometry, 1, &second);
    mover.rotation = begin[i]->rotation;
    rtcEnableGeometry(mover.geometry);
    rtcCommitGeometry(mover.geometry);
  }
  tree_->commit();
}

void LidarWorld::Tree::intersect(const Ray* rays, std::size_t count, double max_distance, RTCRayHit8& query) const {
  EmbreeRayContext context(true);
  alignas(32) int valid[kPacket];
  for (std::size_t i = 0; i < kPacket; ++i) {
    valid[i] = i < count ? -1 : 0;
    const Ray& ray = rays[std::min(i, count - 1)];
    query.ray.org_x[i] = float(ray.from.x), query.ray.org_y[i] = float(ray.from.y);
    query.ray.org_z[i] = float(ray.from.z), query.ray.dir_x[i] = float(ray.direction.x);
    query.ray.dir_y[i] = float(ray.direction.y), query.ray.dir_z[i] = float(ray.direction.z);
    query.ray.tnear[i] = 0, query.ray.tfar[i] = float(max_distance), query.ray.time[i] = ray.time;
    query.ray.mask[i] = 0xffffffffu, query.ray.id[i] = 0, query.ray.flags[i] = 0;
    query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  embree_intersect(scene, valid, query, context);
}

void LidarWorld::cast(const Ray* rays, std::size_t count, double max_distance, Hit* hits) const {
  RTCRayHit8 query;
  tree_->intersect(rays, count, max_distance, query);
  for (std::size_t i = 0; i < count; ++i) {
    hits[i] = {};
    if (query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
      hits[i] = tree_->read(query.hit.primID[i], query.hit.instID[0][i],
                            {query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]}, rays[i],
                            double(query.ray.tfar[i]));
    const double ground = tree_->meet_ground(rays[i], max_distance, hits[i].distance);
    if (ground >= 0)
      hits[i] = {ground, float(-rays[i].direction.z), mean_red_albedo(all_surface_appearances().back(), 1), -1};
  }
}

void LidarWorld::cast(const Ray* rays, std::size_t count, double max_distance, double* distances,
                      std::int32_t* pieces) const {
  RTCRayHit8 query;
  tree_->intersect(rays, count, max_distance, query);
  for (std::size_t i = 0; i < count; ++i) {
    const bool met = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    distances[i] = met ? double(query.ray.tfar[i]) : -1;
    const double ground = tree_->meet_ground(rays[i], max_distance, distances[i]);
    if (ground >= 0) distances[i] = ground;
    if (pieces) pieces[i] = met && ground < 0 ? tree_->piece_of(query.hit.primID[i], query.hit.instID[0][i]) : -1;
  }
}

}  // namespace rubble
