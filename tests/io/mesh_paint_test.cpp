// The colours of users' files: OBJ with its materials, PLY with colours of vertices, glTF.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/base/atomic_file.h"
#include "io/image/image_file.h"
#include "io/image/picture_decoder.h"
#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "tests/io/mesh_files.h"

namespace rubble {
namespace mesh_paint_test {

constexpr char kSheet[] = R"(mtllib sheet.mtl
v 0 0 0
v 2 0 0
v 2 0 1
v 0 0 1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl one
f 1/1 2/2 3/3
usemtl two
f 1/1 3/3 4/4
)";

// Of this width and height: red grows to the right, green downwards.
RgbImage make_ramp(int width, int height) {
  RgbImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.rgb.insert(image.rgb.end(), {std::uint8_t(255 * x / (width - 1)), std::uint8_t(255 * y / (height - 1)), 7});
  return image;
}

double to_linear(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

class MeshPaint : public test::MeshFiles {
 protected:
  TriangleMesh load(const std::string& file, const std::string& text, const std::string& materials = "") {
    if (!materials.empty()) write_text_file(folder_ / "sheet.mtl", materials);
    return MeshFiles::load(file, text);
  }
};

TEST_F(MeshPaint, IsTheImageOfAnObj) {
  write_png(folder_ / "ramp.png", make_ramp(16, 16));
  const TriangleMesh mesh = load("sheet.obj", kSheet, "newmtl one\nKd 0.5 1 1\nmap_Kd ramp.png\nnewmtl two\nKd 0.2 0.3 0.4\n");
  EXPECT_EQ(notes(), "");
  ASSERT_EQ(mesh.paints.size(), 2u);
  const SurfacePaint& one = *mesh.paints[0];
  EXPECT_FLOAT_EQ(one.colour.x, 0.5f);
  ASSERT_EQ(one.albedo.side, 16);
  EXPECT_EQ(one.albedo.texels[4 * 15], 255) << "the first row is the upper one, red on the right";
  EXPECT_EQ(one.albedo.texels[4 * 15 * 16 + 1], 255) << "green in the lowest row";
  EXPECT_EQ(one.relief.side, 0);
  EXPECT_EQ(one.reflectance, 0) << "matt: no highlight is said";
  EXPECT_FLOAT_EQ(mesh.paints[1]->colour.z, 0.4f);
  ASSERT_EQ(mesh.paint_corners.size(), 2u);
  EXPECT_FLOAT_EQ(mesh.paint_corners[0][1].u, 1);
  EXPECT_FLOAT_EQ(mesh.paint_corners[0][1].v, 0) << "v grows upwards";
  EXPECT_FLOAT_EQ(mesh.paint_corners[1][2].v, 1);
}

TEST_F(MeshPaint, IsFoundInAFolderOfTexturesAndByNamesOfOtherSystems) {
  std::filesystem::create_directory(folder_ / "textures");
  const RgbImage ramp = make_ramp(32, 32);
  write_text_file(folder_ / "textures/my ramp.jpg", encode_jpeg(32, 32, ramp.rgb.data(), 95));
  for (const std::string name : {"C:\\work\\my ramp.jpg", "my%20ramp.jpg", "textures/my ramp.jpg"}) {
    const TriangleMesh mesh = load("sheet.obj", kSheet, "newmtl one\nKd 1 1 1\nmap_Kd " + name + "\nnewmtl two\nKd 1 1 1\n");
    EXPECT_EQ(notes(), "") << name;
    ASSERT_EQ(mesh.paints.at(0)->albedo.side, 32) << name;
    double off = 0;
    for (std::size_t i = 0; i < ramp.rgb.size(); ++i)
      off += std::fabs(double(mesh.paints[0]->albedo.texels[i / 3 * 4 + i % 3]) - double(ramp.rgb[i]));
    EXPECT_LT(off / double(ramp.rgb.size()), 2) << name;
  }
}

TEST_F(MeshPaint, SaysWhichImagesCannotBeHad) {
  write_text_file(folder_ / "wood.bmp", "BM and more");
  write_text_file(folder_ / "torn.png", encode_png(make_ramp(40, 40), 0).substr(0, 2000));
  write_text_file(folder_ / "torn.jpg", std::string("\xff\xd8\xff\xe0") + "nothing");
  const auto said = [&](const std::string& image) {
    const TriangleMesh mesh = load("sheet.obj", kSheet, "newmtl one\nKd 1 0 0\nmap_Kd " + image + "\nnewmtl two\nKd 1 1 1\n");
    EXPECT_EQ(mesh.paints.at(0)->albedo.side, 0);
    EXPECT_EQ(mesh.paints[0]->colour.y, 0) << "its plain colour remains";
    return notes();
  };
  EXPECT_EQ(said("gone.png"), "the image gone.png lies neither beside the mesh nor in its folder textures\n");
  EXPECT_EQ(said("wood.bmp"), "the image wood.bmp is neither PNG nor JPEG\n");
  EXPECT_NE(said("torn.png").find("the image torn.png is a damaged PNG: "), std::string::npos);
  EXPECT_NE(said("torn.jpg").find("the image torn.jpg is a damaged JPEG: "), std::string::npos);
}

TEST_F(MeshPaint, IsNoneWhereAFileSaysOneGrey) {
  EXPECT_TRUE(load("sheet.obj", kSheet, "newmtl one\nKd 0.8 0.8 0.8\nnewmtl two\nKd 0.8 0.8 0.8\n").paints.empty());
  const TriangleMesh two = load("sheet.obj", kSheet, "newmtl one\nKd 0.8 0.8 0.8\nnewmtl two\nKd 0.1 0.1 0.1\n");
  ASSERT_EQ(two.paints.size(), 2u) << "two greys are meant";
  EXPECT_FLOAT_EQ(two.paints[1]->colour.x, 0.1f);
}

TEST_F(MeshPaint, TakesHighlightsOfPhong) {
  const TriangleMesh mesh = load("sheet.obj", kSheet, "newmtl one\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 98\nillum 2\nnewmtl two\nKd 1 1 1\n");
  EXPECT_FLOAT_EQ(mesh.paints.at(0)->reflectance, 0.04f);
  EXPECT_NEAR(std::pow(double(mesh.paints[0]->roughness), 2), std::sqrt(2.0 / 100), 1e-5);  // alpha
}

TEST_F(MeshPaint, TakesMetalRoughnessAndNormalsOfAnObj) {
  write_png(folder_ / "normals.png", make_ramp(8, 8));
  const TriangleMesh mesh = load("sheet.obj", kSheet,
                                 "newmtl one\nKd 1 0 0\nPr 0.3\nPm 0.8\nnorm normals.png\nnewmtl two\nKd 1 1 1\n");
  EXPECT_FLOAT_EQ(mesh.paints.at(0)->roughness, 0.3f);
  EXPECT_FLOAT_EQ(mesh.paints[0]->metalness, 0.8f);
  ASSERT_EQ(mesh.paints[0]->relief.side, 8);
  EXPECT_EQ(mesh.paints[0]->relief.texels[4 * 7], 255) << "X in red";
}

TEST_F(MeshPaint, IsThatOfTheVerticesOfAScan) {
  const TriangleMesh mesh = load("scan.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                 "0 0 0 255 0 0\n1 0 0 128 128 128\n0 1 0 0 0 64\n3 0 1 2\n");
  ASSERT_EQ(mesh.paints.size(), 1u);
  ASSERT_EQ(mesh.paint_corners.size(), 1u);
  const auto& corners = mesh.paint_corners[0];
  EXPECT_FLOAT_EQ(corners[0].colour.x, 1);
  EXPECT_NEAR(double(corners[1].colour.y), to_linear(128 / 255.0), 1e-3) << "bytes of scans are sRGB";
  EXPECT_NEAR(double(corners[2].colour.z), to_linear(64 / 255.0), 1e-3);
}

// A square of 1 m that looks to glTF's +Z, its images upright.
std::string make_gltf(const std::string& material, const std::string& images) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
"materials":[)" + material + R"(],"textures":[{"source":0},{"source":1}],"images":)" + images + R"(,
"buffers":[{"uri":"square.bin","byteLength":92}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},
{"buffer":0,"byteOffset":80,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}]})";
}

std::string square_bytes() {
  const float numbers[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,  // places
                           0, 1, 1, 1, 1, 0, 0, 0};             // in images, whose v grows downwards
  const std::uint16_t indices[] = {0, 1, 2, 0, 2, 3};
  return std::string(reinterpret_cast<const char*>(numbers), sizeof numbers) +
         std::string(reinterpret_cast<const char*>(indices), sizeof indices);
}

TEST_F(MeshPaint, IsTheMetalRoughMaterialOfAGltf) {
  write_text_file(folder_ / "square.bin", square_bytes());
  write_png(folder_ / "ramp.png", make_ramp(8, 8));
  RgbImage rough{4, 4, {}};
  for (int i = 0; i < 16; ++i) rough.rgb.insert(rough.rgb.end(), {9, 102, 204});
  write_png(folder_ / "rough.png", rough);
  const TriangleMesh mesh = load("square.gltf", make_gltf(R"({"name":"m","pbrMetallicRoughness":{
"baseColorFactor":[0.25,1,1,1],"baseColorTexture":{"index":0},"metallicFactor":0.5,"roughnessFactor":0.75,
"metallicRoughnessTexture":{"index":1}}})", R"([{"uri":"ramp.png"},{"uri":"rough.png"}])"));
  EXPECT_EQ(notes(), "");
  ASSERT_EQ(mesh.paints.size(), 1u);
  const SurfacePaint& paint = *mesh.paints[0];
  EXPECT_FLOAT_EQ(paint.colour.x, 0.25f);
  EXPECT_FLOAT_EQ(paint.metalness, 0.5f);
  EXPECT_FLOAT_EQ(paint.roughness, 0.75f);
  EXPECT_FLOAT_EQ(paint.reflectance, 0.04f);
  EXPECT_EQ(paint.albedo.side, 8);
  ASSERT_EQ(paint.relief.side, 4);
  EXPECT_EQ(paint.relief.texels[0], 128) << "no relief";
  EXPECT_EQ(paint.relief.texels[2], 102) << "roughness in green";
  EXPECT_EQ(paint.relief.texels[3], 204) << "metal in blue";
  EXPECT_FLOAT_EQ(mesh.paint_corners.at(0)[0].v, 0) << "the square's lower left is that of the image";
}

// Two pixels, the second of which is not there: by hand, as the writer of pictures knows no alpha.
constexpr unsigned char kHalfThere[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4, 0x22, 0x7f,
    0x8a, 0x00, 0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xcf, 0xc0, 0xf0,
    0x1f, 0x88, 0x19, 0x00, 0x10, 0xf8, 0x02, 0xfe, 0xac, 0xe9, 0x46, 0xf8, 0x00, 0x00, 0x00, 0x00,
    0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST_F(MeshPaint, SaysThatNothingIsSeenThrough) {
  write_text_file(folder_ / "half.png", std::string(reinterpret_cast<const char*>(kHalfThere), sizeof kHalfThere));
  write_text_file(folder_ / "square.bin", square_bytes());
  const auto said = [&](const std::string& mode) {
    load("square.gltf", make_gltf(R"({"name":"m",)" + mode + R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})",
                                  R"([{"uri":"half.png"},{"uri":"half.png"}])"));
    return notes();
  };
  EXPECT_EQ(said(R"("alphaMode":"BLEND",)"), "transparent parts of images are drawn opaque\n");
  EXPECT_EQ(said(""), "") << "glTF's default is opaque";
}

TEST_F(MeshPaint, OfAnySizeKeepsTheMeanOfItsLight) {
  const RgbImage ramp = make_ramp(100, 37);
  write_png(folder_ / "ramp.png", ramp);
  const TriangleMesh mesh = load("sheet.obj", kSheet, "newmtl one\nKd 1 1 1\nmap_Kd ramp.png\nnewmtl two\nKd 1 1 1\n");
  const PaintImage& image = mesh.paints.at(0)->albedo;
  ASSERT_EQ(image.side, 128);
  for (std::size_t c = 0; c < 3; ++c) {
    double before = 0, after = 0;
    for (std::size_t i = c; i < ramp.rgb.size(); i += 3) before += to_linear(ramp.rgb[i] / 255.0);
    for (std::size_t i = c; i < image.texels.size(); i += 4) after += to_linear(image.texels[i] / 255.0);
    EXPECT_NEAR(after / 128 / 128, before / 100 / 37, 0.004) << c;
  }
}

TEST_F(MeshPaint, RefusesImagesThatAreTooLarge) {
  EXPECT_THROW(decode_picture(encode_png(RgbImage{kLargestPicture + 1, 1, std::vector<std::uint8_t>(std::size_t(kLargestPicture + 1) * 3)})),
               RunError);
  EXPECT_EQ(decode_picture(encode_png(GrayImage{2, 1, {9, 200}})).rgba, (std::vector<std::uint8_t>{9, 9, 9, 255, 200, 200, 200, 255}));
}

TEST_F(MeshPaint, IsAnotherForAnotherImage) {
  const std::string materials = "newmtl one\nKd 1 1 1\nmap_Kd ramp.png\nnewmtl two\nKd 1 1 1\n";
  const auto hash = [&](int width) {
    write_png(folder_ / "ramp.png", make_ramp(width, 16));
    return load("sheet.obj", kSheet, materials).paints.at(0)->sha256;
  };
  const std::string first = hash(16);
  EXPECT_NE(hash(12), first);
  EXPECT_EQ(hash(16), first);
}

}  // namespace mesh_paint_test
}  // namespace rubble
