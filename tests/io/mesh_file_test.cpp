#include "io/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <cmath>

#include "io/base/atomic_file.h"
#include "io/mesh/stl_writer.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "tests/io/support.h"

namespace rubble {
namespace mesh_file_test {

using test::ScratchFolder;

// A box of 2 x 3 x 4 with quads; its top is of another material. No material file lies beside it.
constexpr char kBox[] = R"(o box
v 0 0 0
v 2 0 0
v 2 3 0
v 0 3 0
v 0 0 4
v 2 0 4
v 2 3 4
v 0 3 4
usemtl concrete_cast
f 1 4 3 2
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
usemtl concrete_fracture
f 5 6 7 8
)";

std::string error_of(const std::string& path) {
  try {
    load_mesh(path);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "no error";
}

TEST(LoadMesh, ReadsWeldsAndKeepsSurfaces) {
  ScratchFolder folder;
  write_text_file(folder / "box.obj", kBox);
  const TriangleMesh mesh = load_mesh(folder / "box.obj");
  EXPECT_EQ(mesh.positions.size(), 8u);
  EXPECT_TRUE(mesh.normals.empty());
  ASSERT_EQ(mesh.triangles.size(), 12u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(calc_volume_properties(mesh).volume, 24.0, 1e-6);
  ASSERT_EQ(mesh.surface_names, (std::vector<std::string>{"concrete_cast", "concrete_fracture"}));
  ASSERT_EQ(mesh.surfaces.size(), 12u);
  for (std::size_t t = 0; t < 12; ++t) {
    bool top = true;
    for (const auto v : mesh.triangles[t]) top = top && mesh.positions[v].z == 4.0f;
    EXPECT_EQ(mesh.surfaces[t], top ? 1 : 0) << "triangle " << t;
  }
}

TEST(LoadMesh, AppliesUnitsAndUpAxis) {
  ScratchFolder folder;
  write_text_file(folder / "box.obj", kBox);
  const TriangleMesh mesh = load_mesh(folder / "box.obj", {0.001, UpAxis::y});
  const Aabb box = mesh.bounds();
  EXPECT_NEAR(box.max.x, 0.002, 1e-9);
  EXPECT_NEAR(box.min.y, -0.004, 1e-9);  // y = -z of the file
  EXPECT_NEAR(box.max.z, 0.003, 1e-9);   // z = y of the file
  EXPECT_NEAR(calc_volume_properties(mesh).volume, 24e-9, 1e-13) << "turned inside out";
}

TEST(LoadMesh, KeepsNormals) {
  ScratchFolder folder;
  write_text_file(folder / "t.obj",
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nvn 0.6 0 0.8\n"
                  "f 1//1 2//1 3//1\nf 2//1 4//2 3//1\n");
  const TriangleMesh mesh = load_mesh(folder / "t.obj");
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.normals.size(), 4u);
  EXPECT_NEAR(mesh.normals[3].x, 0.6f, 1e-6f);
  EXPECT_NEAR(mesh.normals[0].z, 1.0f, 1e-6f);
}

TEST(LoadMesh, SaysWhatIsWrong) {
  ScratchFolder folder;
  write_text_file(folder / "empty.obj", "");
  write_text_file(folder / "points.obj", "v 0 0 0\nv 1 0 0\n");
  write_text_file(folder / "line.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n");
  write_text_file(folder / "noise.stl", "this is not a mesh of any kind");
  write_text_file(folder / "mesh.xyz", "unknown");
  EXPECT_NE(error_of(folder / "none.obj").find("does not exist"), std::string::npos);
  EXPECT_NE(error_of(folder / "none.obj").find("none.obj"), std::string::npos);
  EXPECT_NE(error_of(folder / "empty.obj").find("is empty"), std::string::npos);
  EXPECT_NE(error_of(folder.path()).find("is not a file"), std::string::npos);
  EXPECT_EQ(error_of(folder / "line.obj"), "no error") << "lines beside faces cost a note";
  EXPECT_NE(error_of(folder / "points.obj"), "no error");
  EXPECT_NE(error_of(folder / "noise.stl"), "no error");
  EXPECT_NE(error_of(folder / "mesh.xyz").find("cannot be read as a mesh"), std::string::npos)
      << error_of(folder / "mesh.xyz");
  EXPECT_THROW(load_mesh(folder / "line.obj", {0.0, UpAxis::z}), InputError);
}

TEST(LoadConvexParts, EachObjectIsOnePartInOrder) {
  ScratchFolder folder;
  std::string text(kBox);
  text +=
      "o second\nv 10 0 0\nv 11 0 0\nv 10 1 0\nv 10 0 1\n"
      "f 9 11 10\nf 9 10 12\nf 10 11 12\nf 9 12 11\n";
  write_text_file(folder / "parts.obj", text);
  const auto parts = load_convex_parts(folder / "parts.obj");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].size(), 8u);  // two materials, one object
  ASSERT_EQ(parts[1].size(), 4u);
  for (const Vec3& p : parts[1]) EXPECT_GE(p.x, 10.0);
}

TEST(LoadConvexParts, RefusesAFlatOne) {
  ScratchFolder folder;
  write_text_file(folder / "flat.obj", "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THROW(load_convex_parts(folder / "flat.obj"), InputError);
}

TriangleMesh make_tetrahedron() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TEST(WriteStl, AssimpReadsTheTrianglesWhereTheyWerePut) {
  ScratchFolder folder;
  const TriangleMesh mesh = make_tetrahedron();
  const Pose pose{portable::quat_from_rpy(0.3, -0.4, 1.1), {3, -2, 5}};
  std::vector<MeshInstance> instances{{&mesh, 1.0, {}}, {&mesh, 2.5, pose}};
  write_stl(folder / "pile.stl", instances);
  write_stl(folder / "again.stl", instances);
  EXPECT_EQ(test::read_text(folder / "pile.stl"), test::read_text(folder / "again.stl"));
  EXPECT_EQ(test::read_text(folder / "pile.stl").size(), 84u + 50u * 8u);

  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder / "pile.stl", 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  ASSERT_EQ(scene->mMeshes[0]->mNumFaces, 8u);
  for (unsigned f = 0; f < 8; ++f) {
    const MeshInstance& instance = instances[f / 4];
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned corner = scene->mMeshes[0]->mFaces[f].mIndices[k];
      const aiVector3D& found = scene->mMeshes[0]->mVertices[corner];
      const Vec3 expected = instance.world_from_body *
                            (Vec3(mesh.positions[mesh.triangles[f % 4][k]]) * instance.scale);
      EXPECT_NEAR(static_cast<double>(found.x), expected.x, 1e-6);
      EXPECT_NEAR(static_cast<double>(found.y), expected.y, 1e-6);
      EXPECT_NEAR(static_cast<double>(found.z), expected.z, 1e-6);
    }
  }
}

TEST(WriteStl, IsRightHandedAndReadsBackByOurOwnLoader) {
  ScratchFolder folder;
  const TriangleMesh mesh = make_tetrahedron();
  write_stl(folder / "a.stl", {{&mesh, 2.0, {}}});
  const TriangleMesh back = load_mesh(folder / "a.stl");
  EXPECT_NEAR(calc_volume_properties(back).volume, 8.0 / 6.0, 1e-6) << "mirrored when negative";
}

TEST(WriteStl, AnEmptyPileIsAnEmptyFile) {
  ScratchFolder folder;
  write_stl(folder / "a.stl", {});
  EXPECT_EQ(test::read_text(folder / "a.stl").size(), 84u);
}

}  // namespace mesh_file_test
}  // namespace rubble
