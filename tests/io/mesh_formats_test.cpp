// Mesh files as other programs write them: OBJ and MTL, STL, PLY, COLLADA, 3MF.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/base/atomic_file.h"
#include "io/image/image_file.h"
#include "io/import/polygon.h"
#include "io/base/text_scan.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh_formats/scene_reader.h"
#include "kernel/base/error.h"
#include "tests/io/mesh_files.h"

namespace rubble {
namespace mesh_formats_test {

class MeshFormats : public test::MeshFiles {};

Vec3 size_of(const TriangleMesh& mesh) { return mesh.bounds().max - mesh.bounds().min; }

void expect_size(const TriangleMesh& mesh, const Vec3& size) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(size_of(mesh)[i], size[i], 1e-6) << "axis " << i;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr char kFaces[] = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
constexpr char kCube[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

TEST_F(MeshFormats, ObjTakesEveryWayToWriteANumber) {
  const TriangleMesh mesh = load("a.obj", std::string("\xef\xbb\xbf") +
                                              "v -.5 -.5 0.\r\nv +.5 -5e-1 0\r\nv .5\t.5 -0\r\nv -.5 .5 0\r\nv -.5 -.5 1\r\nv .5 -.5 1.0E0\r\n"
                                              "v .5 .5 1\r\nv -.5 .5 \\\r\n1\r\n" + kFaces);
  expect_size(mesh, {1, 1, 1});
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(calc_volume_properties(mesh).volume, 1, 1e-6);
  EXPECT_TRUE(has(error_of("b.obj", "v 0 0 0\nv 1 O 0\nv 0 1 0\nf 1 2 3\n"), "b.obj:2: expected a number, found \"O\""));
  EXPECT_TRUE(has(error_of("c.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n"), "c.obj:2: expected 3 numbers, found 2"));
  EXPECT_TRUE(has(error_of("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), "d.obj:4: a face names vertex 4, and there are 3"));
}

TEST_F(MeshFormats, ObjLeavesOutLinesAndPointsWithAWord) {
  const TriangleMesh mesh = load("a.obj", std::string(kCube) + kFaces + "l 1 7\np 3\nf 1 2\n");
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_TRUE(has(notes(), "lines beside its faces are left out (first in line 15)")) << notes();
  EXPECT_TRUE(has(notes(), "points beside its faces")) << notes();
  EXPECT_TRUE(has(notes(), "faces of less than three corners")) << notes();
  EXPECT_NE(error_of("b.obj", std::string(kCube) + "l 1 7\n"), "no error");
}

TEST_F(MeshFormats, ObjNeedsNoTexturePlaceOrNormalThatAFaceNames) {
  expect_size(load("a.obj", std::string(kCube) + "f 1/1/9 4/2/9 3/3/9\nf 5/-1 6 7\n"), {1, 1, 1});
  EXPECT_TRUE(has(notes(), "corners without the texture coordinate that they name have none (first in line 9)")) << notes();
  EXPECT_TRUE(has(notes(), "corners without the normal that they name")) << notes();
}

TEST_F(MeshFormats, AFaultInAMaterialFileNeverCostsTheMesh) {
  write_text_file(folder_ / "m.mtl",
                  "newmtl a\nKd 0.5 .1 0\naniso 0.5\nanisor 0\nPcr 1\nNs\nKd zwei\nwhatever 3\nmap_Kd\nKs spectral x.rfl\n");
  const TriangleMesh mesh = load("a.obj", std::string("mtllib m.mtl\n") + kCube + "usemtl a\n" + kFaces + "usemtl b\n");
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_TRUE(has(notes(), "m.mtl:8: unknown keyword \"whatever\"")) << notes();
  EXPECT_TRUE(has(notes(), "m.mtl:7: \"kd\" needs one or three numbers from 0 to 1, not \"zwei\"; it is left out")) << notes();
  EXPECT_TRUE(has(notes(), "m.mtl:9: \"map_kd\" names no image")) << notes();
  EXPECT_FALSE(has(notes(), "aniso")) << notes();
}

TEST_F(MeshFormats, DamagedNumbersOfAMaterialAreLeftOutWithAWord) {
  const auto colour_with = [&](const std::string& line) {
    write_text_file(folder_ / "m.mtl", "newmtl a\nKd 0.1 0.2 0.3\n" + line + "\nnewmtl b\nKd 1 0 0\n");
    const TriangleMesh mesh = load("a.obj", std::string("mtllib m.mtl\n") + kCube + "usemtl a\nf 1 4 3 2\nusemtl b\nf 5 6 7 8\nf 1 2 6 5\n");
    return mesh.paints.at(0)->colour;
  };
  for (const char* line : {"Kd 1 x 0", "Kd 1 0", "Kd -1 255 0", "Kd 1 nan 0", "Kd", "Ks 0 0 2", "Ke 1 1", "Ke -1", "Ns -5", "Ns x",
                           "Pr 1.5", "Pm rough", "d 1e999", "Tr -0.5", "Kd -halo 1"}) {
    EXPECT_EQ(colour_with(line), Vec3f(0.1f, 0.2f, 0.3f)) << line;
    EXPECT_TRUE(has(notes(), "m.mtl:3: ") && has(notes(), "it is left out")) << line << ": " << notes();
  }
  EXPECT_EQ(colour_with("Kd 0.5"), Vec3f(0.5f, 0.5f, 0.5f)) << "grey";
  for (const char* line : {"Kd 0.5", "Kd 1.0000001 0 0 # red", "Ks 0.2", "Ke 0 0 0", "Ns 1000", "Pr 1", "Pm 0", "d -halo 1", "Tr 0"}) {
    colour_with(line);
    EXPECT_EQ(notes(), "") << line;
  }
  EXPECT_EQ(colour_with("Kd 1 0 0 1"), Vec3f(1, 0, 0));
  EXPECT_TRUE(has(notes(), "m.mtl:3: numbers of \"kd\" beyond the first three are left out")) << notes();
}

TEST_F(MeshFormats, ObjReadsEveryMaterialFileAndNamesALostOne) {
  write_text_file(folder_ / "one.mtl", "newmtl one\nKd 0.5 0.1 0\n");
  write_text_file(folder_ / "two.mtl", "newmtl two\nKd 0 0.1 0.5\n");
  write_text_file(folder_ / "with blanks.mtl", "newmtl three\nKd 0 0.7 0\n");
  const std::string faces = "usemtl one\nf 1 4 3 2\nusemtl two\nf 5 6 7 8\nusemtl three\nf 1 2 6 5\n";
  const TriangleMesh mesh = load("a.obj", "mtllib one.mtl two.mtl gone.mtl\nmtllib with blanks.mtl\n" + std::string(kCube) + faces);
  ASSERT_EQ(mesh.paints.size(), 3u);
  EXPECT_FLOAT_EQ(mesh.paints[0]->colour.x, 0.5f);
  EXPECT_FLOAT_EQ(mesh.paints[1]->colour.z, 0.5f);
  EXPECT_FLOAT_EQ(mesh.paints[2]->colour.y, 0.7f);
  EXPECT_EQ(notes(), "the material file gone.mtl was not found beside the mesh; its colours are left out\n");
}

TEST_F(MeshFormats, ColoursOfObjVerticesAreNotDarkened) {
  const TriangleMesh mesh = load("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 0 0 1 1 0 0\n"
                                          "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  ASSERT_EQ(mesh.paints.size(), 1u);
  EXPECT_EQ(mesh.paints[0]->colour, Vec3f(1, 1, 1));
}

TEST_F(MeshFormats, NamesOfMaterialsMayHaveQuotesAndComments) {
  for (const auto& [defined, used] : {std::pair("red", "red # why"), std::pair("red # why", "red"), std::pair("\"red\"", "red"),
                                      std::pair("red", "\"red\""), std::pair("Material #25", "Material #25")}) {
    write_text_file(folder_ / "m.mtl", std::string("newmtl ") + defined + "\nKd 1 0 0\n");
    const TriangleMesh mesh = load("a.obj", std::string("mtllib m.mtl # colours\n") + kCube + "usemtl " + used + "\n" + kFaces);
    ASSERT_EQ(mesh.paints.size(), 1u) << used;
    EXPECT_EQ(mesh.paints[0]->colour, Vec3f(1, 0, 0)) << used;
    EXPECT_EQ(notes(), "") << used;
  }
  load("a.obj", std::string("mtllib m.mtl\n") + kCube + "usemtl blue\n" + kFaces);
  EXPECT_EQ(notes(), "the material \"blue\" is in no material file; its colour is left out\n");
}

TEST_F(MeshFormats, MtlFindsImagesBesideALibraryInASubfolder) {
  std::filesystem::create_directories(std::filesystem::path(folder_ / "sub"));
  write_png(folder_ / "sub/t.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  write_text_file(folder_ / "sub/m.mtl", "newmtl a\nmap_Kd t.png\n");
  const TriangleMesh mesh =
      load("a.obj", "mtllib sub/m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n");
  ASSERT_EQ(mesh.paints.size(), 1u);
  EXPECT_EQ(mesh.paints[0]->albedo.side, 2) << notes();
}

TEST_F(MeshFormats, MtlFindsImagesBehindOptionsAndAmongBlanks) {
  write_png(folder_ / "my image.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  const std::string mesh_text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
  for (const char* line : {"my image.png  \t", "-colorspace sRGB my image.png", "-clamp off -bm 1.0 my image.png", "\"my image.png\"",
                           "-blendu on -imfchan r -mm 0 1 -texres 512 -boost 2 -type sphere -cc on my image.png"}) {
    write_text_file(folder_ / "m.mtl", std::string("newmtl a\nmap_Kd ") + line + "\n");
    const TriangleMesh mesh = load("a.obj", mesh_text);
    ASSERT_EQ(mesh.paints.size(), 1u) << line;
    EXPECT_EQ(mesh.paints[0]->albedo.side, 2) << line << ": " << notes();
  }
  write_text_file(folder_ / "m.mtl", "newmtl a\nmap_Kd -s 2 4 1 -o 0.5 0.25 my image.png\n");
  const TriangleMesh mesh = load("a.obj", mesh_text);
  EXPECT_EQ(mesh.paints.at(0)->albedo.side, 2) << notes();
  EXPECT_NEAR(mesh.paint_corners.at(0)[1].u, 2.5, 1e-6) << "offset + scale * u";
  EXPECT_NEAR(mesh.paint_corners[0][2].v, 4.25, 1e-6);
  EXPECT_NEAR(mesh.paint_corners[0][0].v, 0.25, 1e-6);
}

// One facet of a text STL.
std::string facet(const std::string& normal, const char* a, const char* b, const char* c) {
  return "facet normal " + normal + "\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
}

std::string tetrahedron(const std::string& normal, const char* corner) {
  const char *o = "0 0 0", *x = "1 0 0", *y = "0 1 0", *z = "0 0 1";
  return "solid part of CAD\n" + facet(normal, o, y, x) + facet(normal, o, x, z) + facet(normal, x, y, z) +
         facet(normal, corner, z, y) + "endsolid\n";
}

TEST_F(MeshFormats, TextStlMayHaveACommentPaddingAndNormalsThatAreNoNumbers) {
  const std::string faces = facet("-1.#IND -1.#IND 1.#QNAN", "0 0 0", "0 1 0", "1 0 0") + facet("0 0 0", "0 0 0", "1 0 0", "0 0 1") +
                            facet("0 0 0", "1 0 0", "0 1 0", "0 0 1") + facet("-nan(ind) 0 0", "0 1 0", "0 0 0", "0 0 1");
  for (const std::string& tail : {std::string("\0\0", 2), std::string("\x1a")})
    EXPECT_EQ(load("a.stl", "# made by x\nsolid x\n" + faces + "endsolid x\n" + tail).triangles.size(), 4u);
  EXPECT_EQ(notes(), "12 of 12 normals are zero or not numbers; those of the faces are used\n");
}

TEST_F(MeshFormats, PlyMayHaveAMarkBlanksAndAnyLineEnd) {
  const std::string text = "ply \nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                           "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                           "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  std::string old = text;
  std::replace(old.begin(), old.end(), '\n', '\r');
  for (const std::string& bytes : {text, "\xef\xbb\xbf" + text, old}) EXPECT_EQ(load("a.ply", bytes).triangles.size(), 4u);
}

TEST_F(MeshFormats, CornersThatDifferByRoundingAreOne) {
  for (const char* corner : {"0 0 0", "2.4e-18 0 0", "0 -3e-7 1e-6", "4e-6 0 0"}) {
    const TriangleMesh mesh = load("a.stl", tetrahedron("0 0 0", corner));
    EXPECT_TRUE(is_closed(mesh)) << corner;
    EXPECT_NEAR(calc_volume_properties(mesh).volume, 1 / 6.0, 1e-5) << corner;
  }
  EXPECT_FALSE(is_closed(load("a.stl", tetrahedron("0 0 0", "1e-3 0 0")))) << "a crack of 1 mm is a hole";
}

TEST_F(MeshFormats, NormalsThatAreNoDirectionsAreThoseOfTheFaces) {
  for (const char* normal : {"0 0 0", "nan nan nan", "inf 0 0"}) {
    const TriangleMesh mesh = load("a.stl", tetrahedron(normal, "0 0 0"));
    for (const Vec3f& n : mesh.normals) EXPECT_NEAR(norm(n), 1, 1e-5) << normal;
    EXPECT_EQ(has(notes(), "12 of 12 normals are zero or not numbers"), normal != std::string("0 0 0")) << notes();
  }
  const TriangleMesh mesh = load("a.obj", std::string(kCube) + "vn 0 0 0\nvn nan 0 1\nvn 0 0 1\nf 1//1 4//2 3//3\n");
  for (const Vec3f& n : mesh.normals) EXPECT_NEAR(std::fabs(n.z), 1, 1e-5);
  EXPECT_TRUE(has(notes(), "2 of 3 normals")) << notes();
  EXPECT_TRUE(has(error_of("b.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "not a number"));
  EXPECT_TRUE(has(error_of("c.obj", "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "not a number"));
}

TEST_F(MeshFormats, BinaryStlMayBeginWithSolidAndHoldColours) {
  std::string bytes(80, ' ');
  bytes.replace(0, 5, "solid");
  const auto put = [&bytes](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(std::uint32_t(1));
  for (const float x : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) put(x);
  put(std::uint16_t(0x8000 | 31 << 10));  // red, as VisCAM writes it
  const TriangleMesh mesh = load("a.stl", bytes);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.paint_corners.size(), 1u);
  EXPECT_FLOAT_EQ(mesh.paint_corners[0][0].colour.x, 1);
  EXPECT_FLOAT_EQ(mesh.paint_corners[0][0].colour.y, 0);
  EXPECT_TRUE(has(error_of("b.stl", bytes.substr(0, 120)), "ends early"));
}

// A tetrahedron as binary PLY; first: x of the first vertex.
std::string binary_ply(bool big_endian, float first) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](auto value) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  };
  for (const float x : {first, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) put(x);
  for (const auto& t : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    put(std::uint8_t(3));
    for (const int i : t) put(i);
  }
  return bytes;
}

TEST_F(MeshFormats, PlyMayBeginWithAnyByteAndHaveEitherOrder) {
  for (const bool big : {false, true})
    for (const std::uint32_t bits : {0x0000000au, 0x0a000000u, 0x0d00000du, 0x20000020u}) {
      float first = 0;
      std::memcpy(&first, &bits, 4);
      const TriangleMesh mesh = load("a.ply", binary_ply(big, first));
      EXPECT_TRUE(is_closed(mesh)) << bits;
      EXPECT_NEAR(calc_volume_properties(mesh).volume, 1 / 6.0, 1e-6) << bits;
    }
}

TEST_F(MeshFormats, PlyHasNormalsPlacesStripsAndSaysWhatItLeavesOut) {
  write_png(folder_ / "my scan.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  const TriangleMesh mesh = load("a.ply",
                                 "ply\nformat ascii 1.0\ncomment TextureFile my scan.png\nelement vertex 4\nproperty float x\nproperty float y\n"
                                 "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
                                 "element tristrips 1\nproperty list int int vertex_indices\nelement edge 1\nproperty int vertex1\nend_header\n"
                                 "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n1 1 0 0 0 1 1 1\n5 0 1 2 3 -1\n0\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  for (const auto& t : mesh.triangles)
    EXPECT_GT(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]).z, 0);
  ASSERT_EQ(mesh.paints.size(), 1u);
  EXPECT_EQ(mesh.paints[0]->albedo.side, 2) << notes();
  EXPECT_FLOAT_EQ(mesh.paint_corners[0][1].u, 1);
  EXPECT_TRUE(has(notes(), "lines beside its faces")) << notes();
  EXPECT_TRUE(has(error_of("b.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n"),
                  "a cloud of 1 points"));
}

TEST_F(MeshFormats, ColoursThatAreNoNumbersAreWhite) {
  const TriangleMesh mesh = load("a.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                 "property float red\nproperty float green\nproperty float blue\nelement face 1\n"
                                 "property list uchar int vertex_indices\nend_header\n0 0 0 nan 0 0\n1 0 0 0 1 0\n0 1 0 0 inf 0\n3 0 1 2\n");
  EXPECT_EQ(mesh.paint_corners.at(0)[0].colour, Vec3f(1, 1, 1));
  EXPECT_EQ(mesh.paint_corners[0][1].colour, Vec3f(0, 1, 0));
  EXPECT_EQ(notes(), "colours of vertices that are not numbers are drawn white\n");
}

// A plate of 4 x 2 x 1 units.
std::string plate_dae(const std::string& asset, const std::string& colour, const std::string& image = "") {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" + asset +
         "</asset>" + image +
         R"(<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert><diffuse><color>)" + colour +
         R"(</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">
0 0 0 4 0 0 4 2 0 0 2 0 0 0 1 4 0 1 4 2 1 0 2 1</float_array><technique_common><accessor source="#a" count="8" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="12" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshFormats, ColladaStandsAsItSays) {
  const struct {
    const char* axis;
    Vec3 stated, raw, raw_y;  // heeded; as it is written; of a file without a statement whose pack says up = "y"
  } cases[] = {{"<up_axis>Z_UP</up_axis>", {4, 2, 1}, {4, 2, 1}, {4, 2, 1}},
               {"<up_axis> Y_UP\n</up_axis>", {4, 1, 2}, {4, 2, 1}, {4, 1, 2}},
               {"<up_axis>X_UP</up_axis>", {2, 1, 4}, {4, 2, 1}, {2, 1, 4}},
               {"<!-- <up_axis>X_UP</up_axis> --><up_axis>Y_UP</up_axis>", {4, 1, 2}, {4, 2, 1}, {4, 1, 2}},
               {"<extra><technique profile=\"x\"><up_axis>X_UP</up_axis></technique></extra><up_axis>Y_UP</up_axis>",
                {4, 1, 2}, {4, 2, 1}, {4, 1, 2}},
               {"<up_axis><!-- c -->Y_UP</up_axis>", {4, 1, 2}, {4, 2, 1}, {4, 1, 2}},
               {"<up_axis ><![CDATA[Y_UP]]></up_axis>", {4, 1, 2}, {4, 2, 1}, {4, 1, 2}},
               {"<title><![CDATA[<up_axis>X_UP</up_axis>]]></title>", {4, 2, 1}, {4, 2, 1}, {4, 1, 2}},
               {"", {4, 2, 1}, {4, 2, 1}, {4, 1, 2}}};
  for (const auto& c : cases) {
    const std::string text = plate_dae(c.axis, "1 0 0 1");
    SCOPED_TRACE(c.axis);
    const TriangleMesh heeded = load("a.dae", text);
    expect_size(heeded, c.stated);
    EXPECT_NEAR(calc_volume_properties(heeded).volume, 8, 1e-5) << "turned, not mirrored";
    expect_size(load("a.dae", text, {1, UpAxis::z, false}), c.raw);
    expect_size(load("a.dae", text, {1, UpAxis::y, true}), c.raw_y);
  }
  expect_size(load("a.dae", plate_dae("<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>", "1 0 0 1")),
              {4 * 0.0254, 2 * 0.0254, 0.0254});
}

TEST_F(MeshFormats, BlanksInColladaAreNoFault) {
  for (const char* colour : {" 0.8 0.1 0.1 1 ", "\n\t0.8 0.1 0.1 1\n", "0.8 0.1 0.1 1"}) {
    const TriangleMesh mesh = load("a.dae", plate_dae("", colour));
    expect_size(mesh, {4, 2, 1});
    EXPECT_EQ(notes(), "") << colour;
  }
  EXPECT_EQ(repair_collada("<a x=' > '> 1 <!-- <b> 2 </b> --> </a>\n<c>\n</c>"), "<a x=' > '>1<!-- <b> 2 </b> --> </a>\n<c>\n</c>");
}

TEST_F(MeshFormats, ColladaKeepsItsShapeWhereItsLooksAreBroken) {
  for (const auto& [colour, image] : {std::pair("red", ""), std::pair("1 0 0 1", "<init_from></init_from>"), std::pair("1 0 0 1", "<init_from> \n</init_from>"),
                                      std::pair("1 0 0 1", "<init_from/>")}) {
    const TriangleMesh mesh = load("a.dae", plate_dae("", colour, "<library_images><image id=\"i\">" + std::string(image) + "</image></library_images>"));
    expect_size(mesh, {4, 2, 1});
    EXPECT_EQ(has(notes(), "its materials are left out, since they cannot be read"), std::string(colour) == "red") << image << notes();
  }
}

// A triangle with two sets of texture coordinates; "A" is that of its image.
std::string two_sets_dae(const std::string& sets, const std::string& bound, const std::string& wrap = "") {
  const auto source = [](const std::string& id, const std::string& values, int stride) {
    return "<source id='" + id + "'><float_array id='" + id + "a' count='" + std::to_string(3 * stride) + "'>" + values +
           "</float_array><technique_common><accessor source='#" + id + "a' count='3' stride='" +
           std::to_string(stride) + "'>" +
           (stride == 3 ? "<param name='X' type='float'/><param name='Y' type='float'/><param name='Z' type='float'/>"
                        : "<param name='S' type='float'/><param name='T' type='float'/>") +
           "</accessor></technique_common></source>";
  };
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_images><image id="im"><init_from>t.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="su"><surface type="2D"><init_from>im</init_from></surface></newparam>
<newparam sid="sa"><sampler2D><source>su</source>)" + wrap + R"(</sampler2D></newparam><technique sid="t"><phong><diffuse>
<texture texture="sa" texcoord="A"/></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="mat"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>)" + source("p", "0 0 0 1 0 0 0 1 0", 3) + source("u", "0 0 0 0 0 0", 2) +
         source("w", "1 1 1 1 1 1", 2) + R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>)" + sets + R"(
<p>0 1 2</p></triangles></mesh>
</geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#mat">)" + bound + R"(</instance_material>
</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshFormats, ColladaBindsSetsOfTextureCoordinates) {
  write_png(folder_ / "t.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  const auto sets = [](int first, int second) {
    return "<input semantic=\"TEXCOORD\" source=\"#u\" offset=\"0\" set=\"" + std::to_string(first) +
           "\"/><input semantic=\"TEXCOORD\" source=\"#w\" offset=\"0\" set=\"" + std::to_string(second) + "\"/>";
  };
  const auto bound = [](int set) {
    return "<bind_vertex_input semantic=\"A\" input_semantic=\"TEXCOORD\" input_set=\"" + std::to_string(set) + "\"/>";
  };
  const struct {
    int first, second, bound;
    float u;
  } cases[] = {{0, 1, 0, 0}, {0, 1, 1, 1}, {1, 2, 1, 0}, {1, 2, 2, 1}};
  for (const auto& c : cases) {
    const TriangleMesh mesh = load("a.dae", two_sets_dae(sets(c.first, c.second), bound(c.bound)));
    ASSERT_FALSE(mesh.paint_corners.empty());
    EXPECT_EQ(mesh.paint_corners[0][0].u, c.u) << c.first << c.second << c.bound;
    EXPECT_FALSE(has(notes(), "first set")) << notes();
  }
  load("a.dae", two_sets_dae(sets(0, 1), bound(5)));
  EXPECT_TRUE(has(notes(), "the texture coordinates \"A\" of the effect \"e\" are not of one set in all meshes"))
      << notes();
  load("a.dae", two_sets_dae(sets(0, 1), bound(0), "<wrap_s> CLAMP </wrap_s><wrap_t>WRAP</wrap_t>"));
  EXPECT_TRUE(has(notes(), "the wrapping CLAMP of images of the effect \"e\" is not drawn")) << notes();
}

// A ZIP archive with its files stored.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string out, list;
  const auto put = [](std::string& to, std::uint64_t value, std::size_t bytes) { to.append(reinterpret_cast<const char*>(&value), bytes); };
  for (const auto& [name, content] : files) {
    const std::size_t offset = out.size();
    const auto common = [&](std::string& to) {
      put(to, 20, 2), put(to, 0, 2), put(to, 0, 2), put(to, 0, 4), put(to, 0, 4);
      put(to, content.size(), 4), put(to, content.size(), 4), put(to, name.size(), 2), put(to, 0, 2);
    };
    put(out, 0x04034b50, 4), common(out);
    out += name + content;
    put(list, 0x02014b50, 4), put(list, 20, 2), common(list);
    put(list, 0, 2), put(list, 0, 2), put(list, 0, 2), put(list, 0, 4), put(list, offset, 4);
    list += name;
  }
  const std::size_t begin = out.size();
  out += list;
  put(out, 0x06054b50, 4), put(out, 0, 4), put(out, files.size(), 2), put(out, files.size(), 2), put(out, list.size(), 4), put(out, begin, 4), put(out, 0, 2);
  return out;
}

const std::string kCoreSpace = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
                               "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";

std::string tetrahedron_3mf(const std::string& id) {
  return "<object id=\"" + id + "\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
         "<vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/>"
         "<triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/></triangles></mesh></object>";
}

TEST_F(MeshFormats, ThreemfPlacesComponentsOfOtherFilesOfThePackage) {
  const std::string root = "<model unit=\"millimeter\" requiredextensions=\"p\" " + kCoreSpace +
                           "><resources><object id=\"1\"><components><component objectid=\"7\" p:path=\"/3D/other.model\" "
                           "transform=\"2 0 0 0 3 0 0 0 4 10 0 0\"/></components></object></resources>"
                           "<build><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 5 0\"/></build></model>";
  const std::string other = "<model " + kCoreSpace + "><resources>" + tetrahedron_3mf("7") + "</resources><build/></model>";
  const TriangleMesh mesh = load("a.3mf", zip({{"3D/3dmodel.model", root}, {"3D/other.model", other}}));
  expect_size(mesh, {2, 3, 4});
  EXPECT_NEAR(mesh.bounds().min.x, 10, 1e-6);
  EXPECT_NEAR(mesh.bounds().min.y, 5, 1e-6);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(calc_volume_properties(mesh).volume, 4, 1e-5);
  EXPECT_EQ(notes(), "");
}

// A tag without a name says nothing, however it is written.
TEST_F(MeshFormats, ThreemfPassesOverTagsWithoutAName) {
  const std::string root = "<model " + kCoreSpace + "><resources></><//><></ ></>" + tetrahedron_3mf("1") +
                           "</resources><build><item objectid=\"1\"/></build></model>";
  expect_size(load("a.3mf", zip({{"3D/3dmodel.model", root}})), {1, 1, 1});
}

// Lines with more numbers than the header says, and items that share a line.
TEST_F(MeshFormats, PlyOfTextHasALineForEachItem) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const TriangleMesh more = load("a.ply", header + "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n3 0 2 1 7 7\n3 0 1 3 7 7\n3 1 2 3 7 7\n3 0 3 2 7 7\n");
  expect_size(more, {1, 1, 1});
  EXPECT_TRUE(is_closed(more));
  EXPECT_TRUE(has(notes(), "numbers beyond the properties of its header are left out")) << notes();
  EXPECT_TRUE(is_closed(load("b.ply", header + "0 0 0 1 0 0 0 1 0\n0 0 1 3 0 2 1 3 0 1 3\n3 1 2 3 3 0 3 2\n")));
  EXPECT_EQ(notes(), "");
  EXPECT_TRUE(is_closed(load("c.ply", header + "0 0\n0\n1 0 0\n0 1 0\n0 0 1\n3 0\n2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")));
}

TEST_F(MeshFormats, PlyNamesFacesThatItCannotTake) {
  const auto with = [](const std::string& type, const std::string& faces) {
    const std::string count = std::to_string(std::count(faces.begin(), faces.end(), '\n'));
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face " + count +
           "\nproperty list float " + type + " vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + faces;
  };
  const std::string shell = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  EXPECT_TRUE(is_closed(load("a.ply", with("int", shell + "2 0 3\n0\n1 2\n"))));
  EXPECT_EQ(notes(), "faces of less than three corners are left out: 3\n");
  EXPECT_TRUE(has(error_of("b.ply", with("int", shell + "3 0.7 2.9 3\n")), "b.ply:18: not a whole number")) << error_of("b.ply", with("int", shell + "3 0.7 2.9 3\n"));
  EXPECT_TRUE(has(error_of("c.ply", with("float", "3 0 nan 2\n")), "c.ply:14: not a whole number"));
  EXPECT_TRUE(has(error_of("d.ply", with("int", "2.5 0 1 2\n")), "d.ply:14: not a whole number"));
}

// Colours of base materials are drawn; of what is not, each is named.
TEST_F(MeshFormats, ThreemfColoursAreDrawnOrNamed) {
  const auto with = [](const std::string& resources, const std::string& attributes) {
    std::string object = tetrahedron_3mf("1");
    object.replace(object.find(" type="), 0, attributes);
    return zip({{"3D/3dmodel.model", "<model " + kCoreSpace + " xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">"
                                     "<resources>" + resources + object + "</resources><build><item objectid=\"1\"/></build></model>"}});
  };
  const std::string base = "<basematerials id=\"5\"><base name=\"red\" displaycolor=\"#FF0000\"/></basematerials>";
  const TriangleMesh red = load("a.3mf", with(base, " pid=\"5\" pindex=\"0\""));
  ASSERT_NE(red.paint_of(0), nullptr);
  EXPECT_EQ(red.paint_of(0)->colour, (Vec3f{1, 0, 0}));
  EXPECT_EQ(notes(), "");
  load("b.3mf", with(base + "<m:multiproperties id=\"6\" pids=\"5\"><m:multi pindices=\"0\"/></m:multiproperties>"
                            "<m:pbmetallicdisplayproperties id=\"7\"/>", " pid=\"6\" pindex=\"0\""));
  EXPECT_TRUE(has(notes(), "the mixed colours of its <multiproperties> are not drawn")) << notes();
  EXPECT_TRUE(has(notes(), "its <pbmetallicdisplayproperties>, which say how surfaces shine, are left out")) << notes();
  load("c.3mf", with("<basematerials id=\"5\"><base name=\"red\" displaycolor=\"red\"/></basematerials>", " pid=\"5\" pindex=\"0\""));
  EXPECT_TRUE(has(notes(), "the colour \"red\" is none")) << notes();
}

TEST_F(MeshFormats, ThreemfRefusesWhatItMustKnowByName) {
  const std::string root = "<model requiredextensions=\"b\" xmlns:b=\"http://example.org/beams\" " + kCoreSpace + "><resources>" +
                           tetrahedron_3mf("1") + "</resources><build><item objectid=\"1\"/></build></model>";
  EXPECT_TRUE(has(error_of("a.3mf", zip({{"3D/3dmodel.model", root}})), "requires the 3MF extension \"b\" (http://example.org/beams)"));
  EXPECT_TRUE(has(error_of("b.3mf", "no archive"), "expected a ZIP archive"));
}

TEST(TextScan, NumbersAreReadWithoutALocale) {
  for (const auto& [word, value] : {std::pair(".5", 0.5), std::pair("-.5", -0.5), std::pair("5.", 5.0), std::pair("+1", 1.0),
                                    std::pair("1e-3", 1e-3), std::pair("-2.5E+2", -250.0), std::pair("500000.125", 500000.125)})
    EXPECT_DOUBLE_EQ(read_real(word).value_or(-1), value) << word;
  EXPECT_TRUE(std::isnan(read_real("nan").value_or(0)));
  EXPECT_TRUE(std::isinf(read_real("1e999").value_or(0)));
  for (const char* word : {"", ".", "-", "+-1", "1,5", "0x10", "1.2.3", "niso"}) EXPECT_FALSE(read_real(word)) << word;
}

TEST(Triangulate, KeepsTheAreaOfPolygonsThatAreNotConvex) {
  const std::vector<std::vector<Vec3>> outlines{
      {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1.5, 0.5, 0}},                                        // a dart
      {{0, 0, 5}, {3, 0, 5}, {3, 1, 5}, {1, 1, 5}, {1, 3, 5}, {0, 3, 5}},                      // an L
      {{0, 0, 0}, {0, 0, 3}, {0, 1, 3}, {0, 1, 1}, {0, 2, 1}, {0, 2, 3}, {0, 3, 3}, {0, 3, 0}}};  // a U that looks to -X
  const double areas[] = {1, 5, 7};
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    double sum = 0;
    Vec3 whole;
    for (const auto& t : triangulate(outlines[i])) {
      const Vec3 area = cross(outlines[i][t[1]] - outlines[i][t[0]], outlines[i][t[2]] - outlines[i][t[0]]) * 0.5;
      sum += norm(area), whole += area;
    }
    EXPECT_NEAR(sum, areas[i], 1e-9) << i;
    EXPECT_NEAR(norm(whole), areas[i], 1e-9) << "no triangle is turned over: " << i;
  }
}

}  // namespace mesh_formats_test
}  // namespace rubble
