#include "render/geometry/geometry.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/parallel.h"
#include "kernel/base/random.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

int find_longest_axis(const PreparedMesh& mesh) {
  Vec3f low = mesh.vertices.front().position, high = low;
  for (const PreparedVertex& v : mesh.vertices)
    low = min(low, v.position), high = max(high, v.position);
  return longest_axis(high - low);
}

void place(PreparedScene& out, PlacedMesh piece, std::uint32_t axis, RandomStream& random) {
  const PreparedMesh& mesh = out.meshes[piece.mesh];
  piece.centre = Vec3f(piece.world_from_mesh * (Vec3(mesh.centre) * piece.scale));
  piece.radius = float(mesh.radius * piece.scale);
  piece.first_flag = std::uint32_t(out.cluster_flags);
  piece.first_light = std::uint32_t(out.light_nodes);
  const std::uint32_t start = std::uint32_t(random.next() >> 32), tone = std::uint32_t(random.next() >> 32);
  piece.look_seed = {start, (tone & 0xffff0000u) | axis};
  out.cluster_flags += mesh.levels.front().cluster_count;
  out.light_nodes += mesh.light_nodes.size();
  out.glass = out.glass || mesh.glass;
  if (piece.id != kGroundId && !piece.moves && !piece.surrounds) {
    const Vec3 reach = Vec3(1, 1, 1) * double(piece.radius);
    out.bounds.include(Vec3(piece.centre) - reach);
    out.bounds.include(Vec3(piece.centre) + reach);
  }
  out.placed.push_back(piece);
}

// A place in a body: X and Y from -32 m by steps of 1/1024 m, Z from -2 m by steps of 1/256 m. They begin anew
// after 64 and 32 m, where textures then have a seam.
std::array<std::uint32_t, 2> pack_cut(const CutFrom& cut, std::uint64_t seed) {
  const auto steps = [](double x, double least, double a_metre, std::uint32_t mask) {
    return std::uint32_t(std::int64_t(std::floor((x - least) * a_metre + 0.5))) & mask;
  };
  RandomStream random(seed, "render.bodies." + std::to_string(cut.body));
  const std::uint32_t tone = std::uint32_t(random.next() >> 32) & 0xffff0000u;
  return {steps(cut.origin.x, -32, 1024, 0xffff) | steps(cut.origin.y, -32, 1024, 0xffff) << 16,
          tone | steps(cut.origin.z, -2, 256, 0x1fff) << 3 | 4u | std::uint32_t(cut.grain)};
}

// What moves reaches as far as its origin does, and its mesh about that.
void include_motion(const Scene& scene, PreparedScene& out) {
  if (scene.motion.moving.empty() || scene.motion.reach.empty()) return;
  double most = 0;  // of a mesh's point from its origin
  for (const std::uint32_t i : scene.motion.moving) {
    const PlacedMesh& piece = out.placed[i];
    const PreparedMesh& mesh = out.meshes[piece.mesh];
    most = std::max(most, (double(norm(mesh.centre)) + double(mesh.radius)) * piece.scale);
  }
  const Vec3 margin = Vec3(1, 1, 1) * most;
  out.bounds.include(scene.motion.reach.min - margin);
  out.bounds.include(scene.motion.reach.max + margin);
}

void mark_moving(const Scene& scene, std::vector<std::uint8_t>& moves) {
  moves.assign(scene.instances.size(), 0);
  for (const std::uint32_t i : scene.motion.moving) {
    if (i >= moves.size())
      throw RunError("the motion of the scene refers to instance " + std::to_string(i) + " of " +
                     std::to_string(moves.size()));
    moves[i] = 1;
  }
}

// Each paint once, however many meshes have it.
void number_paints(PreparedScene& scene) {
  std::vector<std::shared_ptr<const SurfacePaint>> all;
  for (PreparedMesh& mesh : scene.meshes) {
    std::vector<std::int32_t> numbers;
    for (const auto& paint : mesh.paints) {
      const auto found =
          std::find_if(all.begin(), all.end(), [&](const auto& p) { return p->sha256 == paint->sha256; });
      numbers.push_back(std::int32_t(found - all.begin()));
      if (found == all.end()) all.push_back(paint), scene.paint_key += paint->sha256;
    }
    for (TrianglePaint& triangle : mesh.paint)
      if (triangle.paint >= 0) triangle.paint = numbers[std::size_t(triangle.paint)];
  }
  if (!all.empty()) scene.paints = std::make_shared<const PaintLayers>(make_paint_layers(all));
}

}  // namespace

PreparedScene prepare_scene(const Scene& scene, int threads) {
  PreparedScene out;
  out.meshes.resize(scene.meshes.size());
  parallel_for(scene.meshes.size(), threads, [&](std::size_t i) {
    if (!scene.meshes[i]) throw RunError("the scene has a mesh without data");
    out.meshes[i] = prepare_mesh(*scene.meshes[i], threads);  // a large one alone takes longer than all others
  });
  number_paints(out);
  std::vector<std::uint32_t> axes;
  for (const PreparedMesh& mesh : out.meshes) axes.push_back(std::uint32_t(find_longest_axis(mesh)));
  std::vector<std::uint8_t> moves;
  mark_moving(scene, moves);
  const std::uint64_t seed = scene.look_seed.value_or(scene.seed);
  RandomStream random(seed, "render.looks");
  for (const SceneInstance& instance : scene.instances) {
    if (instance.mesh >= out.meshes.size())
      throw RunError("an instance of the scene refers to mesh " + std::to_string(instance.mesh) +
                     " of " + std::to_string(out.meshes.size()));
    PlacedMesh piece;
    piece.mesh = instance.mesh;
    piece.scale = double(instance.scale);
    piece.world_from_mesh = instance.world_from_body;
    piece.id = instance.id;
    piece.label = instance.label;
    piece.moves = moves[out.placed.size()];
    piece.surrounds = instance.surrounds;
    out.surrounded = out.surrounded || piece.surrounds;
    // Courses of walls lie level, however high or deep a building is.
    place(out, piece, piece.surrounds ? 0 : axes[instance.mesh], random);
    if (instance.cut_from.body) out.placed.back().look_seed = pack_cut(instance.cut_from, seed);
  }
  include_motion(scene, out);
  if (scene.ground) {
    out.meshes.push_back(prepare_ground(out.bounds));
    PlacedMesh ground;
    ground.mesh = std::uint32_t(out.meshes.size() - 1);
    ground.id = kGroundId;
    ground.label = kGroundLabel;
    place(out, ground, 0, random);
  }
  return out;
}

PreparedScene resting_part(const PreparedScene& scene) {
  PreparedScene out;
  out.meshes = scene.meshes;
  out.paints = scene.paints, out.paint_key = scene.paint_key;
  for (const PlacedMesh& piece : scene.placed) {
    if (piece.moves) continue;
    out.placed.push_back(piece);
    out.placed.back().first_flag = std::uint32_t(out.cluster_flags);
    out.placed.back().first_light = std::uint32_t(out.light_nodes);
    out.cluster_flags += scene.meshes[piece.mesh].levels.front().cluster_count;
    out.light_nodes += scene.meshes[piece.mesh].light_nodes.size();
    out.glass = out.glass || scene.meshes[piece.mesh].glass;
    if (piece.id == kGroundId || piece.surrounds) continue;
    const Vec3 reach = Vec3(1, 1, 1) * double(piece.radius);
    out.bounds.include(Vec3(piece.centre) - reach);
    out.bounds.include(Vec3(piece.centre) + reach);
  }
  return out;
}

}  // namespace rubble
