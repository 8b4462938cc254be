#include "render/rays/ray_world.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
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

struct RayWorld::Tree : EmbreeTree {
  struct Mover {
    RTCGeometry geometry = nullptr;  // owned by the tree
    SceneInstance instance;
    Quat rotation;  // at the first time of the span
    bool stands = false;  // it has not left its place, and is part of `standing`
    std::optional<std::pair<std::optional<Pose>, std::optional<Pose>>> spanned;  // poses at both times of the last span
  };

  std::map<std::uint32_t, std::vector<std::uint16_t>> mesh_looks;  // of those that move, as looks_of()
  std::vector<float> paint_reds;  // mean red albedo of painted surfaces
  std::map<const TriangleMesh*, std::vector<std::uint16_t>> known_looks;  // by looks_of()
  // Instances as one mesh in the world.
  struct Merged {
    std::vector<std::uint16_t> looks;  // by triangle
    std::vector<std::uint32_t> ends;   // of each instance, one past its last triangle
    std::vector<std::int32_t> pieces;  // its id
  };
  Merged resting_mesh, standing_mesh;
  RTCScene standing_scene = nullptr;  // of movers that have not left their places; built anew when one does
  std::vector<Mover> movers;
  std::vector<std::shared_ptr<const SceneMesh>> scene_meshes;
  SceneMotion motion;
  bool ground = true;

  void attach(RTCScene to, const std::vector<Vec3f>& positions,
              const std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    static_assert(sizeof(triangles.front()) == 3 * sizeof(std::uint32_t));
    EmbreeTree::attach(to, positions, triangles.empty() ? nullptr : triangles.front().data(), triangles.size());
  }
  ~Tree() {
    if (standing_scene) rtcReleaseScene(standing_scene);
  }
  const std::vector<std::uint16_t>& looks_of(const TriangleMesh& mesh);
  Merged merge(const std::vector<const SceneInstance*>& instances, RTCScene into);
  void add_resting(const Scene& from);
  void add_movers(const Scene& from);
  void place_at_rest(RTCScene of, unsigned number);
  void stand_up(const std::vector<std::uint8_t>& stands);
  void intersect(const Ray* rays, std::size_t count, double max_distance, RTCRayHit8& query) const;
  const Merged* merged_of(unsigned instance) const;
  std::int32_t piece_of(unsigned primitive, unsigned instance) const;
  Hit read(unsigned primitive, unsigned instance, const Vec3f& normal, const Ray& ray, double t) const;
  // Where a ray that has met something at `before` (negative: nothing) meets the ground first; negative: it does not.
  double meet_ground(const Ray& ray, double max_distance, double before) const {
    if (!ground || ray.direction.z >= 0 || ray.from.z <= 0) return -1;
    const double t = -ray.from.z / ray.direction.z;
    return t > max_distance || (before >= 0 && before <= t) ? -1 : t;
  }
};

RayWorld::Tree::Merged RayWorld::Tree::merge(const std::vector<const SceneInstance*>& instances, RTCScene into) {
  Merged merged;
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const SceneInstance* piece : instances) {
    const TriangleMesh& mesh = scene_meshes.at(piece->mesh)->levels.front();
    const auto base = std::uint32_t(positions.size());
    for (const Vec3f& p : mesh.positions)
      positions.push_back(Vec3f(piece->world_from_body * (Vec3(p) * double(piece->scale))));
    for (const auto& t : mesh.triangles) triangles.push_back({base + t[0], base + t[1], base + t[2]});
    const std::vector<std::uint16_t>& looks = looks_of(mesh);
    merged.looks.insert(merged.looks.end(), looks.begin(), looks.end());
    merged.ends.push_back(std::uint32_t(triangles.size()));
    merged.pieces.push_back(std::int32_t(piece->id));
  }
  attach(into, positions, triangles);
  return merged;
}

// An instance in the world's own frame.
void RayWorld::Tree::place_at_rest(RTCScene of, unsigned number) {
  rtcCommitScene(of);
  const RTCGeometry instance = attach_instance(of, number);
  const RTCQuaternionDecomposition there = decompose({}, 1);
  rtcSetGeometryTransformQuaternion(instance, 0, &there);
  rtcCommitGeometry(instance);
}

void RayWorld::Tree::add_resting(const Scene& from) {
  std::vector<std::uint8_t> moves(from.instances.size(), 0);
  for (const std::uint32_t i : from.motion.moving) moves.at(i) = 1;
  std::vector<const SceneInstance*> still;
  for (std::size_t i = 0; i < from.instances.size(); ++i)
    if (!moves[i]) still.push_back(&from.instances[i]);
  if (from.motion.moving.empty()) {
    resting_mesh = merge(still, scene);
    return;
  }
  resting = new_scene();
  resting_mesh = merge(still, resting);
  place_at_rest(resting, kResting);
}

// stands: by mover.
void RayWorld::Tree::stand_up(const std::vector<std::uint8_t>& stands) {
  std::vector<const SceneInstance*> standing;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    movers[i].stands = stands[i];
    if (!stands[i]) continue;
    standing.push_back(&movers[i].instance);
    rtcDisableGeometry(movers[i].geometry);
  }
  const unsigned number = kResting + 1 + unsigned(movers.size());
  if (standing_scene) {
    rtcDetachGeometry(scene, number);
    rtcReleaseScene(standing_scene);
  }
  standing_scene = nullptr;
  if (standing.empty()) return;
  standing_scene = new_scene();
  standing_mesh = merge(standing, standing_scene);
  place_at_rest(standing_scene, number);
}

void RayWorld::Tree::add_movers(const Scene& from) {
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
    movers.push_back({geometry, piece, {}, false, {}});
  }
}

// Of each triangle of a mesh: an index into all_surface_appearances(), after its end one into paint_reds.
const std::vector<std::uint16_t>& RayWorld::Tree::looks_of(const TriangleMesh& mesh) {
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
RayWorld::Hit RayWorld::Tree::read(unsigned primitive, unsigned instance, const Vec3f& normal,
                                       const Ray& ray, double t) const {
  Vec3 out(normal);
  std::uint16_t look = 0;
  if (const Merged* at_rest = merged_of(instance)) {
    look = at_rest->looks[primitive];
  } else {
    const Mover& mover = movers[instance - kResting - 1];
    out = mover.rotation.rotate(out);
    look = mesh_looks.at(mover.instance.mesh)[primitive];
  }
  out = normalized(out);
  const double cosine = dot(out, ray.direction);
  const float up = float(cosine > 0 ? -out.z : out.z);
  const std::vector<SurfaceAppearance>& known = all_surface_appearances();
  const float red = look < known.size() ? mean_red_albedo(known[look], up) : paint_reds[look - known.size()];
  return {t, float(std::fabs(cosine)), red, piece_of(primitive, instance)};
}

// Null: a mover.
const RayWorld::Tree::Merged* RayWorld::Tree::merged_of(unsigned instance) const {
  if (instance == RTC_INVALID_GEOMETRY_ID || instance == kResting) return &resting_mesh;
  return instance - kResting - 1 < movers.size() ? nullptr : &standing_mesh;
}

std::int32_t RayWorld::Tree::piece_of(unsigned primitive, unsigned instance) const {
  const Merged* const at_rest = merged_of(instance);
  if (!at_rest) return std::int32_t(movers[instance - kResting - 1].instance.id);
  const auto end = std::upper_bound(at_rest->ends.begin(), at_rest->ends.end(), primitive);
  return at_rest->pieces[std::size_t(end - at_rest->ends.begin())];
}

RayWorld::RayWorld(const Scene& from) : tree_(std::make_unique<Tree>()) {
  Tree& t = *tree_;
  t.scene_meshes = from.meshes, t.motion = from.motion, t.ground = from.ground;
  t.add_resting(from);
  t.add_movers(from);
  if (!moves()) t.commit();
}

RayWorld::~RayWorld() = default;

bool RayWorld::moves() const { return !tree_->movers.empty(); }

void RayWorld::span(std::int64_t from_ns, std::int64_t to_ns) {
  if (!moves()) return;
  const std::vector<std::optional<Pose>> begin = tree_->motion.poses_at(from_ns),
                                         end = tree_->motion.poses_at(to_ns);
  const auto is_at_rest = [](const Tree::Mover& mover, const std::optional<Pose>& pose) {
    return pose && *pose == mover.instance.world_from_body;
  };
  std::vector<std::uint8_t> stands(tree_->movers.size(), 0);
  bool changed = false, others_stand = false;
  for (std::size_t i = 0; i < tree_->movers.size(); ++i) {
    const Tree::Mover& mover = tree_->movers[i];
    stands[i] = tree_->motion.may_rest && is_at_rest(mover, begin[i]) && is_at_rest(mover, end[i]);
    others_stand = others_stand || bool(stands[i]) != mover.stands;
  }
  if (others_stand) tree_->stand_up(stands), changed = true;
  for (std::size_t i = 0; i < tree_->movers.size(); ++i) {
    Tree::Mover& mover = tree_->movers[i];
    if (mover.spanned && mover.spanned->first == begin[i] && mover.spanned->second == end[i]) continue;
    mover.spanned.emplace(begin[i], end[i]);
    if (mover.stands) continue;
    changed = true;
    if (!begin[i] || !end[i]) {
      rtcDisableGeometry(mover.geometry);
      continue;
    }
    Pose last = *end[i];  // the shorter way round
    const Quat &a = begin[i]->rotation, &b = last.rotation;
    if (a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0) last.rotation = {-b.w, -b.x, -b.y, -b.z};
    const RTCQuaternionDecomposition first = decompose(*begin[i], mover.instance.scale),
                                     second = decompose(last, mover.instance.scale);
    rtcSetGeometryTransformQuaternion(mover.geometry, 0, &first);
    rtcSetGeometryTransformQuaternion(mover.geometry, 1, &second);
    mover.rotation = begin[i]->rotation;
    rtcEnableGeometry(mover.geometry);
    rtcCommitGeometry(mover.geometry);
  }
  if (changed) tree_->commit();
}

void RayWorld::Tree::intersect(const Ray* rays, std::size_t count, double max_distance, RTCRayHit8& query) const {
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

void RayWorld::cast(const Ray* rays, std::size_t count, double max_distance, Hit* hits) const {
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

void RayWorld::cast(const Ray* rays, std::size_t count, double max_distance, double* distances,
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
