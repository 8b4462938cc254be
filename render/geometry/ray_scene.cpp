#include "render/geometry/ray_scene.h"

#include <algorithm>
#include <utility>

#include "render/materials/glass.h"

namespace rubble {

namespace {

// Farthest from the origin that anything but the ground is; unit: m.
double find_reach(const PreparedScene& scene) {
  double reach = 1;
  for (const PlacedMesh& piece : scene.placed)
    if (piece.id != kGroundId) reach = std::max(reach, norm(Vec3(piece.centre)) + double(piece.radius));
  if (!scene.bounds.empty()) reach = std::max({reach, norm(scene.bounds.min), norm(scene.bounds.max)});
  return reach;
}

RayTree::Line line_of(const RayScene::Ray& ray) { return {ray.from, ray.direction, ray.nearest, ray.farthest, 0}; }

}  // namespace

RayScene::RayScene(const PreparedScene& scene, Detail detail, Part part)
    : scene_(scene), detail_(detail), part_(part), tree_(find_reach(scene)) {
  add_resting();
  add_moving();
  tree_.commit();
  moment_ = scene.moment;
}

RayScene::~RayScene() = default;

const PreparedLevel& RayScene::level_of(const PreparedMesh& mesh) const {
  return detail_ == Detail::finest ? mesh.levels.front() : mesh.levels.back();
}

bool RayScene::has(const PreparedTriangle& triangle) const {
  return part_ == Part::all || (triangle.material == glass_appearance()) == (part_ == Part::glass);
}

RayScene::MeshBlocks& RayScene::blocks_of(std::uint32_t number) {
  const auto [found, is_new] = meshes_.try_emplace(number);
  MeshBlocks& blocks = found->second;
  const PreparedMesh& mesh = scene_.meshes[number];
  if (!is_new || (part_ == Part::glass && !mesh.glass)) return blocks;
  const PreparedLevel& level = level_of(mesh);
  for (std::uint32_t t = level.first_triangle; t < level.first_triangle + level.triangle_count; ++t)
    if (has(mesh.triangles[t])) blocks.sources.push_back(t);
  blocks.order = order_blocks(std::uint32_t(blocks.sources.size()), [&](std::uint32_t t) {
    const auto& v = mesh.triangles[blocks.sources[t]].vertices;
    return std::array<Vec3f, 3>{mesh.vertices[v[0]].position, mesh.vertices[v[1]].position, mesh.vertices[v[2]].position};
  });
  return blocks;
}

void RayScene::add_triangles(std::uint32_t placed, const MeshBlocks& blocks) {
  placed_.push_back({triangle_count_, placed, &blocks});
  triangle_count_ += std::uint32_t(blocks.sources.size());
  while (runs_.size() * kRun < triangle_count_) runs_.push_back(std::uint32_t(placed_.size() - 1));
}

RayScene::Triangle RayScene::triangle(std::uint32_t number) const {
  std::size_t i = runs_[number / kRun];
  while (i + 1 < placed_.size() && placed_[i + 1].first <= number) ++i;
  return {placed_[i].placed, placed_[i].blocks->sources[number - placed_[i].first]};
}

void RayScene::add_resting() {
  // A scene has millions of them, so a vector that grows would take twice the memory.
  std::size_t block_count = 0;
  for (const PlacedMesh& piece : scene_.placed)
    if (!piece.moves) block_count += blocks_of(piece.mesh).order.ends.size();
  std::vector<TriangleBlock> blocks;
  blocks.reserve(block_count);
  std::vector<Vec3f> positions;
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (piece.moves) continue;
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    const MeshBlocks& of_mesh = blocks_of(piece.mesh);
    if (of_mesh.sources.empty()) continue;
    positions.clear();
    for (const PreparedVertex& v : mesh.vertices)
      positions.push_back(Vec3f(piece.world_from_mesh * (Vec3(v.position) * piece.scale)));
    append_blocks(
        of_mesh.order,
        [&](std::uint32_t t) {
          const auto& v = mesh.triangles[of_mesh.sources[t]].vertices;
          return std::array<Vec3f, 3>{positions[v[0]], positions[v[1]], positions[v[2]]};
        },
        triangle_count_, blocks);
    add_triangles(i, of_mesh);
  }
  tree_.parts().emplace_back().mesh = tree_.add_mesh(std::move(blocks));
}

void RayScene::add_moving() {
  std::map<std::uint32_t, double> smallest_scales;
  for (const PlacedMesh& piece : scene_.placed) {
    double& smallest = smallest_scales.try_emplace(piece.mesh, piece.scale).first->second;
    if (piece.moves) smallest = std::min(smallest, piece.scale);
  }
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (!piece.moves) continue;
    MeshBlocks& blocks = blocks_of(piece.mesh);
    if (blocks.sources.empty()) continue;
    if (blocks.in_tree == RayTree::kNone) {
      const PreparedMesh& mesh = scene_.meshes[piece.mesh];
      blocks.in_tree = tree_.add_mesh(
          blocks.order,
          [&](std::uint32_t t) {
            const auto& v = mesh.triangles[blocks.sources[t]].vertices;
            return std::array<Vec3f, 3>{mesh.vertices[v[0]].position, mesh.vertices[v[1]].position, mesh.vertices[v[2]].position};
          },
          smallest_scales.at(piece.mesh));
    }
    RayTree::Part& part = tree_.parts().emplace_back();
    part.first_id = triangle_count_;
    add_triangles(i, blocks);
    movers_.push_back(i);
    place(movers_.size() - 1);
  }
}

void RayScene::place(std::size_t mover) {
  const PlacedMesh& piece = scene_.placed[movers_[mover]];
  RayTree::Part& part = tree_.parts()[1 + mover];
  part.mesh = piece.there ? meshes_.at(piece.mesh).in_tree : RayTree::kNone;
  part.scale = piece.scale;
  part.first = part.last = piece.world_from_mesh;
}

void RayScene::follow() {
  if (moment_ == scene_.moment) return;
  moment_ = scene_.moment;
  for (std::size_t i = 0; i < movers_.size(); ++i) place(i);
  tree_.commit();
}

RayScene::Hit RayScene::cast(const Vec3f& from, const Vec3f& d, float nearest, float farthest) const {
  const RayTree::Hit hit = tree_.meet({from, d, nearest, farthest, 0});
  return {hit.triangle, hit.distance, hit.back};
}

bool RayScene::blocked(const Vec3f& from, const Vec3f& d, float nearest, float farthest) const {
  return tree_.hides({from, d, nearest, farthest, 0});
}

void RayScene::cast_many(const Ray* rays, std::size_t count, Order order, PreciseHit* hits) const {
  const auto put = [&](std::size_t i, const RayTree::Hit& hit) {
    hits[i] = {hit.triangle, hit.distance, hit.u, hit.v, hit.back};
  };
  if (order == Order::scattered) {
    for (std::size_t i = 0; i < count; ++i) put(i, tree_.meet(line_of(rays[i])));
    return;
  }
  for (std::size_t first = 0; first < count; first += RayTree::kPacket) {
    const std::size_t of_packet = std::min(RayTree::kPacket, count - first);
    RayTree::Line lines[RayTree::kPacket];
    RayTree::Hit met[RayTree::kPacket];
    for (std::size_t i = 0; i < of_packet; ++i) lines[i] = line_of(rays[first + i]);
    tree_.meet_packet(lines, of_packet, met);
    for (std::size_t i = 0; i < of_packet; ++i) put(first + i, met[i]);
  }
}

void RayScene::blocked_many(const Ray* rays, std::size_t count, Order order, std::uint8_t* hidden) const {
  if (order == Order::scattered) {
    for (std::size_t i = 0; i < count; ++i) hidden[i] = tree_.hides(line_of(rays[i]));
    return;
  }
  for (std::size_t first = 0; first < count; first += RayTree::kPacket) {
    const std::size_t of_packet = std::min(RayTree::kPacket, count - first);
    RayTree::Line lines[RayTree::kPacket];
    for (std::size_t i = 0; i < of_packet; ++i) lines[i] = line_of(rays[first + i]);
    tree_.hide_packet(lines, of_packet, hidden + first);
  }
}

}  // namespace rubble
