#include "void_scenes.h"

#include <cmath>

namespace rubble::testing {

void VoidScene::add(TriangleMesh mesh, const Pose& pose) {
  PieceState piece;
  piece.type = int(meshes.size());
  piece.world_from_body = pose;
  piece.status = PieceStatus::fixed;
  pile.pieces.push_back(piece);
  meshes.push_back(std::move(mesh));
}

std::vector<const TriangleMesh*> VoidScene::pointers() const {
  std::vector<const TriangleMesh*> result;
  for (const TriangleMesh& mesh : meshes) result.push_back(&mesh);
  return result;
}

TriangleMesh make_box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        Vec3f(Vec3{i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh make_pipe(double length, double inner, double outer, int sides) {
  TriangleMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / sides;
    for (const double x : {0.0, length}) {
      for (const double r : {inner, outer}) {
        mesh.positions.push_back(Vec3f(Vec3{x, r * std::cos(angle), r * std::sin(angle)}));
      }
    }
  }
  // Around the wall's section: inner and outer corner at 0, inner and outer corner at length.
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t a = std::uint32_t(4 * i), b = std::uint32_t(4 * ((i + 1) % sides));
    const auto quad = [&](std::uint32_t p, std::uint32_t q) {
      mesh.triangles.push_back({a + p, b + p, b + q});
      mesh.triangles.push_back({a + p, b + q, a + q});
    };
    quad(0, 2);  // bore: normal towards the axis
    quad(3, 1);  // outside
    quad(1, 0);  // end at 0
    quad(2, 3);  // end at length
  }
  return mesh;
}

void add_room(VoidScene& scene, const Vec3& low, const Vec3& high, double thickness) {
  const double t = thickness;
  scene.add(make_box({low.x - t, low.y - t, 0}, {low.x, high.y + t, high.z + t}));
  scene.add(make_box({high.x, low.y - t, 0}, {high.x + t, high.y + t, high.z + t}));
  scene.add(make_box({low.x - t, low.y - t, 0}, {high.x + t, low.y, high.z + t}));
  scene.add(make_box({low.x - t, high.y, 0}, {high.x + t, high.y + t, high.z + t}));
  scene.add(make_box({low.x - t, low.y - t, high.z}, {high.x + t, high.y + t, high.z + t}));
}

}  // namespace rubble::testing
