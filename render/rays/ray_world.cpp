#include "render/rays/ray_world.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/geometry/ray_tree.h"
#include "render/materials/paint_layers.h"
#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

constexpr double kTravel = 20;  // how far from its place in the scene what moves may go; unit: m

// Farthest from the origin that anything is; unit: m.
double find_reach(const Scene& scene) {
  double reach = 1;
  std::vector<double> radii;  // of the meshes
  for (const auto& mesh : scene.meshes) {
    radii.push_back(0);
    for (const Vec3f& p : mesh->levels.front().positions) radii.back() = std::max(radii.back(), norm(Vec3(p)));
  }
  for (const SceneInstance& piece : scene.instances)
    reach = std::max(reach, norm(piece.world_from_body.translation) + radii.at(piece.mesh) * double(piece.scale));
  for (const std::uint32_t i : scene.motion.moving) {
    const SceneInstance& piece = scene.instances[i];
    reach = std::max(reach, kTravel + norm(piece.world_from_body.translation) + radii.at(piece.mesh) * double(piece.scale));
  }
  return reach;
}

TriangleCorners corners_of(const TriangleMesh& mesh) {
  return [&mesh](std::uint32_t t) {
    const auto& v = mesh.triangles[t];
    return std::array<Vec3f, 3>{mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
  };
}

}  // namespace

struct RayWorld::Tree {
  // Parts of the tree: what rests, movers that stand, and the others.
  static constexpr std::uint32_t kResting = 0, kStanding = 1, kMovers = 2;

  explicit Tree(const Scene& from) : tree(find_reach(from)) {}

  struct Mover {
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
  Merged resting_mesh, standing_mesh;  // standing: movers that have not left their places; built anew when one does
  std::vector<Mover> movers;
  std::vector<std::shared_ptr<const SceneMesh>> scene_meshes;
  SceneMotion motion;
  bool ground = true;

  RayTree tree;
  std::map<const TriangleMesh*, BlockOrder> orders;
  std::map<std::uint32_t, std::uint32_t> meshes_in_tree;  // of those that move, by their numbers

  const std::vector<std::uint16_t>& looks_of(const TriangleMesh& mesh);
  const BlockOrder& order_of(const TriangleMesh& mesh);
  // Puts instances into a part of the tree.
  Merged merge(const std::vector<const SceneInstance*>& instances, std::uint32_t part);
  void add_resting(const Scene& from);
  void add_movers(const Scene& from);
  void stand_up(const std::vector<std::uint8_t>& stands);
  void meet(const Ray* rays, std::size_t count, double max_distance, RayTree::Hit* met) const {
    RayTree::Line lines[kPacket];
    for (std::size_t i = 0; i < count; ++i)
      lines[i] = {Vec3f(rays[i].from), Vec3f(rays[i].direction), 0, float(max_distance), rays[i].time};
    tree.meet_packet(lines, count, met);
  }
  const Merged* merged_of(std::uint32_t part) const;
  std::uint32_t triangle_of(const RayTree::Hit& hit) const { return hit.triangle - tree.parts()[hit.part].first_id; }
  std::int32_t piece_of(const RayTree::Hit& hit) const;
  Hit read(const RayTree::Hit& hit, const Ray& ray) const;
  // Where a ray that has met something at `before` (negative: nothing) meets the ground first; negative: it does not.
  double meet_ground(const Ray& ray, double max_distance, double before) const {
    if (!ground || ray.direction.z >= 0 || ray.from.z <= 0) return -1;
    const double t = -ray.from.z / ray.direction.z;
    return t > max_distance || (before >= 0 && before <= t) ? -1 : t;
  }
};

const BlockOrder& RayWorld::Tree::order_of(const TriangleMesh& mesh) {
  const auto [found, is_new] = orders.try_emplace(&mesh);
  if (is_new) found->second = order_blocks(std::uint32_t(mesh.triangles.size()), corners_of(mesh));
  return found->second;
}

RayWorld::Tree::Merged RayWorld::Tree::merge(const std::vector<const SceneInstance*>& instances, std::uint32_t part) {
  Merged merged;
  std::size_t count = 0;  // a scene has millions: a vector that grows would take twice the memory
  for (const SceneInstance* piece : instances) count += order_of(scene_meshes.at(piece->mesh)->levels.front()).ends.size();
  std::vector<TriangleBlock> blocks;
  blocks.reserve(count);
  std::vector<Vec3f> positions;
  for (const SceneInstance* piece : instances) {
    const TriangleMesh& mesh = scene_meshes.at(piece->mesh)->levels.front();
    positions.clear();
    for (const Vec3f& p : mesh.positions)
      positions.push_back(Vec3f(piece->world_from_body * (Vec3(p) * double(piece->scale))));
    append_blocks(
        order_of(mesh),
        [&](std::uint32_t t) {
          const auto& v = mesh.triangles[t];
          return std::array<Vec3f, 3>{positions[v[0]], positions[v[1]], positions[v[2]]};
        },
        std::uint32_t(merged.looks.size()), blocks);
    const std::vector<std::uint16_t>& looks = looks_of(mesh);
    merged.looks.insert(merged.looks.end(), looks.begin(), looks.end());
    merged.ends.push_back(std::uint32_t(merged.looks.size()));
    merged.pieces.push_back(std::int32_t(piece->id));
  }
  tree.parts()[part].mesh = tree.add_mesh(std::move(blocks));
  return merged;
}

void RayWorld::Tree::add_resting(const Scene& from) {
  std::vector<std::uint8_t> moves(from.instances.size(), 0);
  for (const std::uint32_t i : from.motion.moving) moves.at(i) = 1;
  std::vector<const SceneInstance*> still;
  for (std::size_t i = 0; i < from.instances.size(); ++i)
    if (!moves[i]) still.push_back(&from.instances[i]);
  tree.parts().resize(kMovers);
  resting_mesh = merge(still, kResting);
}

// stands: by mover.
void RayWorld::Tree::stand_up(const std::vector<std::uint8_t>& stands) {
  std::vector<const SceneInstance*> standing;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    movers[i].stands = stands[i];
    if (!stands[i]) continue;
    standing.push_back(&movers[i].instance);
    tree.parts()[kMovers + i].mesh = RayTree::kNone;
  }
  tree.drop_mesh(tree.parts()[kStanding].mesh);
  standing_mesh = merge(standing, kStanding);
}

void RayWorld::Tree::add_movers(const Scene& from) {
  std::map<std::uint32_t, double> smallest_scales;
  for (const std::uint32_t i : from.motion.moving) {
    const SceneInstance& piece = from.instances[i];
    double& smallest = smallest_scales.try_emplace(piece.mesh, double(piece.scale)).first->second;
    smallest = std::min(smallest, double(piece.scale));
  }
  auto next_id = std::uint32_t(resting_mesh.looks.size());
  for (const std::uint32_t i : from.motion.moving) {
    const SceneInstance& piece = from.instances[i];
    const auto [in_tree, is_new] = meshes_in_tree.try_emplace(piece.mesh);
    if (is_new) {
      const TriangleMesh& mesh = from.meshes.at(piece.mesh)->levels.front();
      in_tree->second = tree.add_mesh(order_of(mesh), corners_of(mesh), smallest_scales.at(piece.mesh));
      mesh_looks[piece.mesh] = looks_of(mesh);
    }
    RayTree::Part& part = tree.parts().emplace_back();
    part.scale = double(piece.scale);
    part.first_id = next_id;
    next_id += std::uint32_t(mesh_looks.at(piece.mesh).size());
    movers.push_back({piece, {}, false, {}});
  }
  tree.parts()[kStanding].first_id = next_id;
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

RayWorld::Hit RayWorld::Tree::read(const RayTree::Hit& hit, const Ray& ray) const {
  Vec3 out(hit.normal);
  std::uint16_t look = 0;
  if (const Merged* at_rest = merged_of(hit.part)) {
    look = at_rest->looks[triangle_of(hit)];
  } else {
    const Mover& mover = movers[hit.part - kMovers];
    out = mover.rotation.rotate(out);
    look = mesh_looks.at(mover.instance.mesh)[triangle_of(hit)];
  }
  out = normalized(out);
  const double cosine = dot(out, ray.direction);
  const float up = float(cosine > 0 ? -out.z : out.z);
  const std::vector<SurfaceAppearance>& known = all_surface_appearances();
  const float red = look < known.size() ? mean_red_albedo(known[look], up) : paint_reds[look - known.size()];
  return {double(hit.distance), float(std::fabs(cosine)), red, piece_of(hit)};
}

// Null: a mover.
const RayWorld::Tree::Merged* RayWorld::Tree::merged_of(std::uint32_t part) const {
  return part == kResting ? &resting_mesh : part == kStanding ? &standing_mesh : nullptr;
}

std::int32_t RayWorld::Tree::piece_of(const RayTree::Hit& hit) const {
  const Merged* const at_rest = merged_of(hit.part);
  if (!at_rest) return std::int32_t(movers[hit.part - kMovers].instance.id);
  const auto end = std::upper_bound(at_rest->ends.begin(), at_rest->ends.end(), triangle_of(hit));
  return at_rest->pieces[std::size_t(end - at_rest->ends.begin())];
}

RayWorld::RayWorld(const Scene& from) : tree_(std::make_unique<Tree>(from)) {
  Tree& t = *tree_;
  t.scene_meshes = from.meshes, t.motion = from.motion, t.ground = from.ground;
  t.add_resting(from);
  t.add_movers(from);
  if (!moves()) t.tree.commit();
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
    RayTree::Part& part = tree_->tree.parts()[Tree::kMovers + i];
    part.mesh = RayTree::kNone;
    if (!begin[i] || !end[i]) continue;
    part.mesh = tree_->meshes_in_tree.at(mover.instance.mesh);
    Pose last = *end[i];  // the shorter way round
    const Quat &a = begin[i]->rotation, &b = last.rotation;
    if (a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0) last.rotation = {-b.w, -b.x, -b.y, -b.z};
    part.first = *begin[i], part.last = last;
    mover.rotation = begin[i]->rotation;
  }
  if (changed) tree_->tree.commit();
}

void RayWorld::cast(const Ray* rays, std::size_t count, double max_distance, Hit* hits) const {
  RayTree::Hit met[kPacket];
  tree_->meet(rays, count, max_distance, met);
  for (std::size_t i = 0; i < count; ++i) {
    const RayTree::Hit& hit = met[i];
    hits[i] = {};
    if (hit.triangle != RayTree::kNone) hits[i] = tree_->read(hit, rays[i]);
    const double ground = tree_->meet_ground(rays[i], max_distance, hits[i].distance);
    if (ground >= 0)
      hits[i] = {ground, float(-rays[i].direction.z), mean_red_albedo(all_surface_appearances().back(), 1), -1};
  }
}

void RayWorld::cast(const Ray* rays, std::size_t count, double max_distance, double* distances,
                    std::int32_t* pieces) const {
  RayTree::Hit met[kPacket];
  tree_->meet(rays, count, max_distance, met);
  for (std::size_t i = 0; i < count; ++i) {
    const RayTree::Hit& hit = met[i];
    const bool is_met = hit.triangle != RayTree::kNone;
    distances[i] = is_met ? double(hit.distance) : -1;
    const double ground = tree_->meet_ground(rays[i], max_distance, distances[i]);
    if (ground >= 0) distances[i] = ground;
    if (pieces) pieces[i] = is_met && ground < 0 ? tree_->piece_of(hit) : -1;
  }
}

}  // namespace rubble
