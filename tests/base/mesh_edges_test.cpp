#include "kernel/base/mesh_edges.h"

#include <gtest/gtest.h>

namespace rubble {
namespace mesh_edges_test {

TriangleMesh make_tetrahedron() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TEST(OpenEdges, OfAClosedMeshThereAreNone) {
  EXPECT_EQ(find_open_edges(make_tetrahedron()).count, 0u);
}

TEST(OpenEdges, OfAHoleAreItsBorder) {
  TriangleMesh mesh = make_tetrahedron();
  mesh.triangles.pop_back();  // 0 3 2
  const OpenEdges open = find_open_edges(mesh);
  EXPECT_EQ(open.count, 3u);
  EXPECT_FALSE(is_closed(mesh));
  EXPECT_EQ(open.from, Vec3f(0, 0, 0));  // the first triangle's first edge: 0 to 2
  EXPECT_EQ(open.to, Vec3f(0, 1, 0));
  EXPECT_EQ(open.triangles, 1);
  EXPECT_EQ(describe(open),
            "3 edges are not shared by two triangles, one each way; the first, from (0, 0, 0) to "
            "(0, 1, 0), by 1");
}

TEST(OpenEdges, CountATurnedTriangleAndATriangleTooMany) {
  TriangleMesh turned = make_tetrahedron();
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_EQ(find_open_edges(turned).count, 3u);
  EXPECT_EQ(find_open_edges(turned).triangles, 2);
  TriangleMesh fin = make_tetrahedron();
  fin.positions.push_back({5, 5, 5});
  fin.triangles.push_back({0, 1, 4});
  const OpenEdges open = find_open_edges(fin);
  EXPECT_EQ(open.count, 3u) << "the edge 0 to 1 and two of the fin";
  EXPECT_EQ(open.triangles, 3);
}

// Equal corners are one, as is_closed has it.
TEST(OpenEdges, WeldEqualPositions) {
  TriangleMesh mesh = make_tetrahedron();
  mesh.positions.push_back({0, 0, 0});
  mesh.triangles[3][0] = 4;
  EXPECT_EQ(find_open_edges(mesh).count, 0u);
  EXPECT_TRUE(is_closed(mesh));
}

}  // namespace mesh_edges_test
}  // namespace rubble
