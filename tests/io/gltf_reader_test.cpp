// glTF 2.0 as other programs write it: integer accessors, extensions, skins, morph targets, instances, places of textures.
#include "io/mesh_formats/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "io/base/atomic_file.h"
#include "io/image/image_file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "tests/io/mesh_files.h"

namespace rubble {
namespace gltf_reader_test {

// A glTF file in pieces: bytes of its one buffer, accessors, and what a test says of the rest.
class GltfFile {
 public:
  // The number of an accessor of these values, in the component type T.
  template <typename T>
  int add(const std::vector<double>& values, const char* type, int component, bool normalized, std::size_t width) {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    const std::size_t begin = bytes_.size();
    for (const double value : values) {
      const T number = T(value);
      bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    views_ += (views_.empty() ? "" : ",") + std::string("{\"buffer\":0,\"byteOffset\":") + std::to_string(begin) +
              ",\"byteLength\":" + std::to_string(bytes_.size() - begin) + "}";
    accessors_ += (accessors_.empty() ? "" : ",") + std::string("{\"bufferView\":") + std::to_string(count_) +
                  ",\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(values.size() / width) +
                  ",\"type\":\"" + type + "\"" + (normalized ? ",\"normalized\":true}" : "}");
    return count_++;
  }
  int floats(const std::vector<double>& values, const char* type, std::size_t width) {
    return add<float>(values, type, 5126, false, width);
  }
  // rest: members at the top, beginning with a comma.
  std::string text(const std::string& uri, const std::string& rest) const {
    return R"({"asset":{"version":"2.0"},"buffers":[{"uri":")" + uri + "\",\"byteLength\":" + std::to_string(bytes_.size()) +
           "}],\"bufferViews\":[" + views_ + "],\"accessors\":[" + accessors_ + "]" + rest + "}";
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_, views_, accessors_;
  int count_ = 0;
};

const std::vector<double> kSolid{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};  // a tetrahedron
const std::vector<double> kFacesOfSolid{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

std::string mesh_of(int position, int indices, const std::string& more = "") {
  return ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":" + std::to_string(position) + more + "},\"indices\":" +
         std::to_string(indices) + "}]}]";
}

class Gltf : public test::MeshFiles {
 protected:
  TriangleMesh load(const GltfFile& file, const std::string& rest, const std::string& uri = "a.bin") {
    if (uri.find("data:") != 0) write_text_file(folder_ / "my data%.bin", file.bytes()), write_text_file(folder_ / "a.bin", file.bytes());
    write_text_file(folder_ / "a.gltf", file.text(uri, rest));
    return importer_.load_mesh(folder_ / "a.gltf");
  }
  std::string error_of(const GltfFile& file, const std::string& rest, const std::string& uri = "a.bin") {
    return mistake_of([&] { load(file, rest, uri); });
  }
  static void expect_box(const TriangleMesh& mesh, const Vec3& min, const Vec3& max, double within = 1e-6) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(mesh.bounds().min[i], min[i], within) << "axis " << i;
      EXPECT_NEAR(mesh.bounds().max[i], max[i], within) << "axis " << i;
    }
  }

};

constexpr char kNode[] = ",\"nodes\":[{\"mesh\":0}]";

TEST_F(Gltf, PositionsMayBeOfEveryComponentType) {
  const auto check = [&](auto type, int component, bool normalized, double full, double expected) {
    GltfFile file;
    std::vector<double> values;
    for (const double x : kSolid) values.push_back(x * full);
    const int positions = file.add<decltype(type)>(values, "VEC3", component, normalized, 3);
    const int indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
    const TriangleMesh mesh = load(file, ",\"extensionsRequired\":[\"KHR_mesh_quantization\"]" + std::string(kNode) + mesh_of(positions, indices));
    SCOPED_TRACE(component);
    expect_box(mesh, {0, 0, 0}, {expected, expected, expected}, 1e-6 * expected);
    EXPECT_NEAR(calc_volume_properties(mesh).volume, expected * expected * expected / 6, 1e-5 * std::pow(expected, 3));
  };
  check(std::int8_t(), 5120, false, 100, 100), check(std::int8_t(), 5120, true, 127, 1);
  check(std::uint8_t(), 5121, false, 200, 200), check(std::uint8_t(), 5121, true, 255, 1);
  check(std::int16_t(), 5122, false, 1000, 1000), check(std::int16_t(), 5122, true, 32767, 1);
  check(std::uint16_t(), 5123, false, 1000, 1000), check(std::uint16_t(), 5123, true, 65535, 1);
  check(float(), 5126, false, 2.5, 2.5);
}

TEST_F(Gltf, NormalizedSignedIntegersEndAtMinusOne) {
  GltfFile file;
  const int positions = file.add<std::int8_t>({-128, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -127}, "VEC3", 5120, true, 3);
  const int indices = file.add<std::uint16_t>(kFacesOfSolid, "SCALAR", 5123, false, 1);
  expect_box(load(file, kNode + mesh_of(positions, indices)), {-1, 0, -1}, {1, 1, 0});
}

TEST_F(Gltf, TexturePlacesMayBeIntegers) {
  write_png(folder_ / "t.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint32_t>(kFacesOfSolid, "SCALAR", 5125, false, 1);
  const int places = file.add<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 65535, 65535}, "VEC2", 5123, true, 2);
  const TriangleMesh mesh = load(file, std::string(kNode) + R"(,"images":[{"uri":"t.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(positions) + ",\"TEXCOORD_0\":" + std::to_string(places) +
                                           "},\"indices\":" + std::to_string(indices) + ",\"material\":0}]}]");
  ASSERT_FALSE(mesh.paint_corners.empty());
  for (const auto& triangle : mesh.paint_corners)
    for (const PaintCorner& corner : triangle) {
      EXPECT_TRUE(corner.u == 0 || corner.u == 1) << corner.u;
      EXPECT_TRUE(corner.v == 0 || corner.v == 1) << corner.v;
    }
}

TEST_F(Gltf, WrappingThatIsNotDrawnIsNoted) {
  write_png(folder_ / "t.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  const auto notes_with = [&](const std::string& sampler) {
    GltfFile file;
    const int positions = file.floats(kSolid, "VEC3", 3);
    const int indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
    const int places = file.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2", 2);
    load(file, std::string(kNode) + R"(,"images":[{"uri":"t.png"}],"samplers":[)" + sampler + R"(],
"textures":[{"source":0,"sampler":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":)" +
                   std::to_string(positions) + ",\"TEXCOORD_0\":" + std::to_string(places) +
                   "},\"indices\":" + std::to_string(indices) + ",\"material\":0}]}]");
    return notes();
  };
  EXPECT_EQ(notes_with(R"({"wrapS":10497})").find("wrapping"), std::string::npos);
  EXPECT_EQ(notes_with("").find("wrapping"), std::string::npos) << "a sampler that is not there";
  EXPECT_NE(notes_with(R"({"wrapT":33648})").find("the wrapping MIRRORED_REPEAT of images is not drawn"), std::string::npos);
  EXPECT_NE(notes_with(R"({"wrapS":33071})").find("the wrapping CLAMP_TO_EDGE of images is not drawn"), std::string::npos);
}

TEST_F(Gltf, BuffersMayHaveEncodedNamesOrLieInTheFile) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const std::string rest = kNode + mesh_of(positions, indices);
  expect_box(load(file, rest, "my%20data%25.bin"), {0, 0, 0}, {1, 1, 1});
  expect_box(load(file, rest, "my data%.bin"), {0, 0, 0}, {1, 1, 1});
  std::string encoded = "data:application/octet-stream;base64,";
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < file.bytes().size() / 3 * 3; i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | std::uint8_t(file.bytes()[i + k]);
    for (int k = 18; k >= 0; k -= 6) encoded += digits[word >> k & 63];
  }
  ASSERT_EQ(file.bytes().size() % 3, 0u);
  expect_box(load(file, rest, encoded), {0, 0, 0}, {1, 1, 1});
  EXPECT_NE(error_of(file, rest, "gone.bin").find("buffers[0]: the file gone.bin was not found"), std::string::npos);
  EXPECT_NE(error_of(file, rest, "data:;base64,AAAA").find("bufferViews[0]: needs"), std::string::npos);
}

TEST_F(Gltf, RefusesOrNamesExtensionsThatItMustKnow) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const std::string rest = kNode + mesh_of(positions, indices);
  const std::string error = error_of(file, rest + ",\"extensionsRequired\":[\"EXT_meshopt_compression\"]");
  EXPECT_NE(error.find("requires the glTF extension EXT_meshopt_compression, which is not known (export without compression"), std::string::npos) << error;
  EXPECT_NE(error_of(file, rest + ",\"extensionsRequired\":[\"ACME_folding\"]").find("ACME_folding"), std::string::npos);
  EXPECT_EQ(error_of(file, rest + ",\"extensionsUsed\":[\"ACME_folding\"]"), "no error");
  load(file, rest + ",\"extensionsRequired\":[\"KHR_texture_basisu\"]");
  EXPECT_EQ(notes(), "the file requires the extension KHR_texture_basisu, which is not known: what it says of looks is left out\n");
}

TEST_F(Gltf, ImagesOfOtherKindsAreNamedWithTheirExtension) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const int places = file.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2", 2);
  load(file, std::string(kNode) + R"(,"images":[{"uri":"t.webp"}],"textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}],
"materials":[{"emissiveFactor":[0,0.5,0],"normalTexture":{"index":0,"scale":0.5},"extensions":{"KHR_materials_clearcoat":{}},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(positions) + ",\"TEXCOORD_0\":" + std::to_string(places) +
                 "},\"indices\":" + std::to_string(indices) + ",\"material\":0}]}]");
  EXPECT_NE(notes().find("the image t.webp is of the extension EXT_texture_webp"), std::string::npos) << notes();
  EXPECT_NE(notes().find("light that surfaces give is not drawn"), std::string::npos) << notes();
  EXPECT_NE(notes().find("the scale of the image of normals is not applied"), std::string::npos) << notes();
  EXPECT_NE(notes().find("the extension KHR_materials_clearcoat of materials is not drawn"), std::string::npos) << notes();
}

TEST_F(Gltf, JointsBendSkinsAndTheNodeOfTheMeshDoesNot) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const int joints = file.add<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", 5121, false, 4);
  const int weights = file.add<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, "VEC4", 5121, true, 4);
  const int inverse = file.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1}, "MAT4", 16);
  const std::string rest = R"(,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"translation":[50,0,0]},{"scale":[0.5,0.5,0.5],"children":[2]},{"translation":[0,0,8]}],
"skins":[{"joints":[1,2],"inverseBindMatrices":)" + std::to_string(inverse) + "}]" +
                           mesh_of(positions, indices, ",\"JOINTS_0\":" + std::to_string(joints) + ",\"WEIGHTS_0\":" + std::to_string(weights));
  const TriangleMesh mesh = load(file, rest);
  expect_box(mesh, {0, 0, 0}, {0.5, 0.5, 4});  // the tip: (0, 0, 1) - 1 in its joint, 8 up, halved
  EXPECT_EQ(notes(), "");
  EXPECT_NE(error_of(file, rest.substr(0, rest.find("\"joints\":[1,2]")) + "\"joints\":[1]" + rest.substr(rest.find("\"joints\":[1,2]") + 14)).find("joint that its skin does not have"),
            std::string::npos);
}

TEST_F(Gltf, WeightsMoveMorphTargets) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const int up = file.floats({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3", 3), out = file.floats({0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3);
  const std::string mesh = ",\"meshes\":[{\"weights\":[1,0.25],\"primitives\":[{\"attributes\":{\"POSITION\":" + std::to_string(positions) + "},\"indices\":" +
                           std::to_string(indices) + ",\"targets\":[{\"POSITION\":" + std::to_string(up) + "},{\"POSITION\":" + std::to_string(out) + "}]}]}]";
  expect_box(load(file, kNode + mesh), {0, 0, 0}, {2, 1, 2});
  expect_box(load(file, ",\"nodes\":[{\"mesh\":0,\"weights\":[0,0]}]" + mesh), {0, 0, 0}, {1, 1, 1});
}

TEST_F(Gltf, InstancesAreAllThere) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const int shift = file.floats({0, 0, 0, 5, 0, 0}, "VEC3", 3), scale = file.floats({1, 1, 1, 2, 2, 2}, "VEC3", 3);
  const TriangleMesh mesh = load(file, ",\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],\"nodes\":[{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":" +
                                           std::to_string(shift) + ",\"SCALE\":" + std::to_string(scale) + "}}}}]" + mesh_of(positions, indices));
  EXPECT_EQ(mesh.triangles.size(), 8u);
  expect_box(mesh, {0, 0, 0}, {7, 2, 2});
  EXPECT_NEAR(calc_volume_properties(mesh).volume, 9 / 6.0, 1e-5);
}

TEST_F(Gltf, MirroredNodesStayClosedAndStripsAreTriangles) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  const TriangleMesh mirrored = load(file, ",\"nodes\":[{\"mesh\":0,\"scale\":[-2,1,1]}]" + mesh_of(positions, indices));
  expect_box(mirrored, {-2, 0, 0}, {0, 1, 1});
  EXPECT_NEAR(calc_volume_properties(mirrored).volume, 2 / 6.0, 1e-6) << "negative: inside out";
  const int strip = file.add<std::uint8_t>({0, 2, 1, 3, 0, 2}, "SCALAR", 5121, false, 1);
  const TriangleMesh stripped = load(file, std::string(kNode) + ",\"meshes\":[{\"primitives\":[{\"mode\":5,\"attributes\":{\"POSITION\":" + std::to_string(positions) +
                                               "},\"indices\":" + std::to_string(strip) + "},{\"mode\":1,\"attributes\":{\"POSITION\":" + std::to_string(positions) + "}}]}]");
  EXPECT_EQ(stripped.triangles.size(), 4u);
  EXPECT_NEAR(calc_volume_properties(stripped).volume, 1 / 6.0, 1e-6);
  EXPECT_NE(notes().find("lines beside its faces are left out (meshes[0].primitives[1])"), std::string::npos) << notes();
}

// The square's first corner is at the lower left of the image; its place there after the member `use` of the texture.
TEST_F(Gltf, TexturesLieWhereTheirTransformAndSetSay) {
  write_png(folder_ / "t.png", RgbImage{2, 2, std::vector<std::uint8_t>(12, 90)});
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>({0, 1, 2}, "SCALAR", 5121, false, 1);
  const int first = file.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2", 2), second = file.floats({0.5, 0.5, 0.75, 0.5, 0.5, 0.75, 1, 1}, "VEC2", 2);
  const auto corners = [&](const std::string& use, const std::string& more = "") {
    return load(file, std::string(kNode) + R"(,"images":[{"uri":"t.png"},{"uri":"t.png"}],"textures":[{"source":0},{"source":1}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0)" + use + "}}" + more + R"(}],
"meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(positions) + ",\"TEXCOORD_0\":" + std::to_string(first) + ",\"TEXCOORD_1\":" +
                           std::to_string(second) + "},\"indices\":" + std::to_string(indices) + ",\"material\":0}]}]")
        .paint_corners.at(0);
  };
  const auto expect = [](const PaintCorner& corner, double u, double v_down) {
    EXPECT_NEAR(corner.u, u, 1e-6);
    EXPECT_NEAR(1 - corner.v, v_down, 1e-6);
  };
  const auto plain = corners("");
  expect(plain[1], 1, 0), expect(plain[2], 0, 1);
  const auto other = corners(",\"texCoord\":1");
  expect(other[0], 0.5, 0.5), expect(other[1], 0.75, 0.5);
  const auto moved = corners(R"(,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"scale":[0.5,2]}})");
  expect(moved[0], 0.5, 0.25), expect(moved[1], 1, 0.25), expect(moved[2], 0.5, 2.25);
  const auto turned = corners(R"(,"texCoord":1,"extensions":{"KHR_texture_transform":{"rotation":1.5707963267948966,"texCoord":0}})");
  expect(turned[1], 0, -1), expect(turned[2], 1, 0);  // counter-clockwise in the image
  EXPECT_EQ(notes(), "");
  corners("", R"(,"normalTexture":{"index":1,"texCoord":1})");
  EXPECT_NE(notes().find("the image t.png with the normals of the material \"materials[0]\" is left out: it lies otherwise"), std::string::npos) << notes();
  corners(",\"texCoord\":5");
  EXPECT_NE(notes().find("lies by texture coordinates (set 5) that its mesh does not have"), std::string::npos) << notes();
}

TEST_F(Gltf, SparseAccessorsChangeWhatIsUnder) {
  GltfFile file;
  const int at = file.add<std::uint8_t>({1, 2, 3}, "SCALAR", 5121, false, 1), what = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3);
  const int indices = file.add<std::uint8_t>(kFacesOfSolid, "SCALAR", 5121, false, 1);
  std::string text = file.text("a.bin", kNode + mesh_of(3, indices));
  const std::size_t end = text.find("],\"nodes\"");
  text.insert(end, ",{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":3,\"indices\":{\"bufferView\":" + std::to_string(at) +
                       ",\"componentType\":5121},\"values\":{\"bufferView\":" + std::to_string(what) + "}}}");
  write_text_file(folder_ / "a.bin", file.bytes());
  write_text_file(folder_ / "s.gltf", text);
  expect_box(importer_.load_mesh(folder_ / "s.gltf"), {0, 0, 0}, {1, 1, 1});
}

TEST_F(Gltf, NamesTheElementThatIsWrong) {
  GltfFile file;
  const int positions = file.floats(kSolid, "VEC3", 3), indices = file.add<std::uint8_t>({0, 1, 9}, "SCALAR", 5121, false, 1);
  EXPECT_NE(error_of(file, kNode + mesh_of(positions, indices)).find("meshes[0].primitives[0]: has a corner 9, and 4 vertices"), std::string::npos);
  EXPECT_NE(error_of(file, kNode + mesh_of(positions, 7)).find("names accessors[7], and there are 2"), std::string::npos);
  EXPECT_NE(error_of(file, kNode + mesh_of(indices, positions)).find("does not fit its use"), std::string::npos);
  EXPECT_NE(error_of(file, ",\"nodes\":[{\"mesh\":0,\"children\":[0]}],\"scenes\":[{\"nodes\":[0]}]" + mesh_of(positions, indices)).find("nodes[0]: has two parents"), std::string::npos);
  EXPECT_NE(error_of(file, ",\"nodes\":[{\"mesh\":\"zero\"}]" + mesh_of(positions, indices)).find("another type"), std::string::npos);
  write_text_file(folder_ / "b.gltf", "{\"asset\":{\"version\":\"3.0\"}}");
  EXPECT_THROW(importer_.load_mesh(folder_ / "b.gltf"), InputError);
  write_text_file(folder_ / "c.glb", std::string("glTF\2\0\0\0\x40\0\0\0\xff\xff\0\0JSON{}", 22));
  EXPECT_THROW(importer_.load_mesh(folder_ / "c.glb"), InputError);
}

}  // namespace gltf_reader_test
}  // namespace rubble
