// Triangles that face the wrong way, and STL files that end too early or too late.
#include "io/import/mesh_winding.h"

#include <gtest/gtest.h>

#include <cstring>

#include "io/base/atomic_file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace mesh_winding_test {

using test::ScratchFolder;

// A cube of side 2 r about a place, appended; outwards: as solids face.
void add_cube(TriangleMesh& mesh, const Vec3& middle, double r, bool outwards = true) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(Vec3f(middle + Vec3(i & 1 ? r : -r, i & 2 ? r : -r, i & 4 ? r : -r)));
  const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads)
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}})
      mesh.triangles.push_back({first + t[0], first + t[outwards ? 1 : 2], first + t[outwards ? 2 : 1]});
  mesh.surfaces.assign(mesh.triangles.size(), 0);
}

void turn(TriangleMesh& mesh, std::size_t triangle) { std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]); }

double volume(const TriangleMesh& mesh) { return is_closed(mesh) ? calc_volume_properties(mesh).volume : NAN; }

TEST(MeshWinding, TheFewerAreTurned) {
  TriangleMesh mesh;
  add_cube(mesh, {5, 0, 0}, 0.5);
  EXPECT_EQ(agree_on_outside(mesh), "");
  turn(mesh, 3), turn(mesh, 8);
  const TriangleMesh before = mesh;
  EXPECT_EQ(agree_on_outside(mesh), "2 of its 12 triangles face inwards: they are turned");
  EXPECT_NEAR(volume(mesh), 1, 1e-6);
  EXPECT_EQ(mesh.positions.size(), before.positions.size());
}

TEST(MeshWinding, WhatIsInsideOutIsTurned) {
  TriangleMesh mesh;
  add_cube(mesh, {5, 0, 0}, 0.5, false);
  EXPECT_EQ(agree_on_outside(mesh), "its triangles face inwards: all are turned");
  EXPECT_NEAR(volume(mesh), 1, 1e-6);
}

// Normals of a file may face as its triangles do, or be right already.
TEST(MeshWinding, NormalsPointOutwardsInTheEnd) {
  for (const float sign : {1.0f, -1.0f}) {
    TriangleMesh mesh;
    add_cube(mesh, {5, 0, 0}, 0.5, false);
    for (const Vec3f& p : mesh.positions) mesh.normals.push_back({sign * (p.x - 5), sign * p.y, sign * p.z});
    EXPECT_NE(agree_on_outside(mesh), "");
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      EXPECT_GT(dot(Vec3(mesh.normals[v]), Vec3(mesh.positions[v]) - Vec3(5, 0, 0)), 0) << sign << " " << v;
  }
}

TEST(MeshWinding, EachSolidHasAnOutsideAndACavityAnInside) {
  TriangleMesh mesh;
  add_cube(mesh, {0, 0, 0}, 2, false);
  add_cube(mesh, {0.5, 0, 0}, 1, false);  // faces inwards, as the wall of a cavity must
  add_cube(mesh, {5, 0, 0}, 0.5);
  EXPECT_EQ(agree_on_outside(mesh), "12 of its 36 triangles face inwards: they are turned");
  EXPECT_NEAR(volume(mesh), 64 - 8 + 1, 1e-5);
}

TEST(MeshWinding, WhatHasNoInsideStays) {
  TriangleMesh open;
  add_cube(open, {}, 1);
  turn(open, 0);
  open.triangles.pop_back(), open.surfaces.pop_back();
  TriangleMesh band;  // of Moebius: five triangles
  for (int i = 0; i < 5; ++i) band.positions.push_back({float(i), float(i * i), float(i * i * i)});
  for (std::uint32_t i = 0; i < 5; ++i) band.triangles.push_back({i, (i + 1) % 5, (i + 2) % 5});
  for (TriangleMesh* mesh : {&open, &band}) {
    const auto before = mesh->triangles;
    EXPECT_EQ(agree_on_outside(*mesh), "");
    EXPECT_EQ(mesh->triangles, before);
  }
}

std::string facet(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  std::string bytes(50, '\0');
  const Vec3f corners[3] = {a, b, c};
  std::memcpy(bytes.data() + 12, corners, sizeof corners);
  return bytes;
}

// What the import says of a file of that text.
struct Imported {
  std::string error;
  std::vector<std::string> notes;
};

Imported import(const std::string& bytes) {
  const ScratchFolder folder;
  write_text_file(folder / "a.stl", bytes);
  MeshImporter importer;
  try {
    importer.load_mesh(folder / "a.stl", {});
    return {"", importer.notes().shape};
  } catch (const InputError& error) {
    return {error.diagnostics().front().text(), {}};
  }
}

TEST(StlReader, SaysWhereAFileEndsTooEarlyOrTooLate) {
  const std::string whole = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_TRUE(import(whole + "endsolid a\n").notes.empty());
  EXPECT_EQ(import(whole).notes, std::vector<std::string>{"`endsolid` is missing: the file may be cut off"});
  EXPECT_NE(import(whole + "facet normal 0 0 1\nouter").error.find("the STL file ends early: within a facet"), std::string::npos);
  EXPECT_NE(import(whole + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\n").error.find("less than three corners"), std::string::npos);
  EXPECT_NE(import("solid a\nfacet normal 0 0 1\nvertex 0 0 0\n" + whole.substr(8)).error.find("a.stl:4: a facet of less than three corners"), std::string::npos);
  std::string four = whole;
  four.insert(four.find("endloop"), "vertex 2 2 0\n");
  EXPECT_NE(import(four).error.find("a.stl:7: a facet of more than three corners"), std::string::npos) << import(four).error;
  EXPECT_TRUE(import("\xef\xbb\xbf" + whole + "endsolid a\n").notes.empty());
  EXPECT_EQ(import("\xef\xbb\xbf" + whole + "endsolid a\n").error, "") << "a byte order mark";
  EXPECT_NE(import(std::string("\xff\xfes\0o\0", 6) + std::string(100, ' ')).error.find("UTF-16"), std::string::npos);
  const std::string count("\1\0\0\0", 4), two = facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) + facet({0, 0, 1}, {1, 0, 1}, {0, 1, 1});
  EXPECT_EQ(import(std::string(80, ' ') + count + two).notes,
            std::vector<std::string>{"50 bytes behind the 1 facets that the file states are left out: is the count right?"});
  EXPECT_NE(import(std::string(80, ' ') + std::string("\3\0\0\0", 4) + two).error.find("the STL file ends early"), std::string::npos);
}

}  // namespace mesh_winding_test
}  // namespace rubble
