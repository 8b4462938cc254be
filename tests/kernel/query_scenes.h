// Scenes for the tests of queries.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/queries/queries.h"
#include "scenes.h"

namespace rubble::testing {

inline TriangleMesh box_mesh(double x, double y, double z) {
  return make_collision_meshes({box_type("box", x, y, z)})[0];
}

// Latitude and longitude; with `rings` rings inscribed in the unit sphere.
inline TriangleMesh sphere_mesh(int rings) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const auto [s, c] = portable::sincos(portable::kPi * i / rings);
      const auto [sl, cl] = portable::sincos(2 * portable::kPi * k / around);
      mesh.positions.push_back(Vec3f(Vec3{s * cl, s * sl, c}));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const auto at = [&](int ring, int step) {
        return std::uint32_t(ring * around + step % around);
      };
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

inline PieceState piece_at(int type, const Vec3& position, double scale = 1, const Quat& rotation = {}) {
  PieceState piece;
  piece.type = type;
  piece.scale = scale;
  piece.world_from_body = {rotation, position};
  piece.status = PieceStatus::resting;
  return piece;
}

struct QueryScene {
  PileState pile;
  std::vector<TriangleMesh> meshes;

  std::vector<const TriangleMesh*> pointers() const {
    std::vector<const TriangleMesh*> result;
    for (const TriangleMesh& mesh : meshes) result.push_back(&mesh);
    return result;
  }
  PileQueries queries(bool ground = true) const { return {pile, pointers(), ground}; }
};

// Overlapping chunks, slabs, pipes and blocks of many sizes in a heap.
inline QueryScene random_scene(std::uint64_t seed, int pieces) {
  QueryScene scene;
  scene.meshes = make_collision_meshes(rubble_types());
  RandomStream random(seed, "query scene");
  for (int i = 0; i < pieces; ++i) {
    const Vec3 position{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(0.3, 4)};
    scene.pile.pieces.push_back(piece_at(int(random.below(scene.meshes.size())), position,
                                         random.uniform(0.1, 1.5), random.rotation()));
  }
  scene.pile.pieces[5].status = PieceStatus::lost;
  return scene;
}

inline Vec3 random_point(RandomStream& random) {
  return {random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-0.5, 6)};
}

}  // namespace rubble::testing
