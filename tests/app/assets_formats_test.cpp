// `rubble assets check` of meshes in every format.
#include <gtest/gtest.h>

#include <cstdint>

#include "tests/app/own_pack.h"

namespace rubble::testing {
namespace assets_formats_test {

using Json = nlohmann::json;

// A box of 100 x 200 x 300 units, in the formats that people export; made by hand, so that what is
// read is what the format's description says.
struct MeshText {
  const char* file;
  std::string text;
};

std::string corner(int i, const char* between) {
  return std::string(i & 1 ? "100" : "0") + between + (i & 2 ? "200" : "0") + between +
         (i & 4 ? "300" : "0");
}

std::string obj_box() {
  std::string text = "o box\nusemtl steel_galvanised\n";
  for (int i = 0; i < 8; ++i) text += "v " + corner(i, " ") + "\n";
  for (const auto& f : kBoxFaces)
    text += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " +
            std::to_string(f[2] + 1) + "\n";
  return text;
}

std::string stl_box() {
  std::string text = "solid box\n";
  for (const auto& f : kBoxFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : f) text += "vertex " + corner(i, " ") + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

std::string ply_box() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
      "property float z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 8; ++i) text += corner(i, " ") + "\n";
  for (const auto& f : kBoxFaces)
    text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
            "\n";
  return text;
}

std::string base64(const std::string& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string gltf_box() {
  std::string bytes;
  for (int i = 0; i < 8; ++i) {
    for (const float x : {i & 1 ? 100.f : 0.f, i & 2 ? 200.f : 0.f, i & 4 ? 300.f : 0.f})
      bytes.append(reinterpret_cast<const char*>(&x), 4);
  }
  for (const auto& f : kBoxFaces) {
    for (const int i : f) {
      const auto index = std::uint16_t(i);
      bytes.append(reinterpret_cast<const char*>(&index), 2);
    }
  }
  const Json gltf = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"materials", {{{"name", "Material.001"}}}},
      {"meshes",
       {{{"primitives",
          {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}}}},
      {"accessors",
       {{{"bufferView", 0},
         {"componentType", 5126},
         {"count", 8},
         {"type", "VEC3"},
         {"min", {0, 0, 0}},
         {"max", {100, 200, 300}}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 96}},
        {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}}}},
      {"buffers",
       {{{"byteLength", bytes.size()},
         {"uri", "data:application/octet-stream;base64," + base64(bytes)}}}}};
  return gltf.dump();
}

std::string fbx_box() {
  std::string vertices, indices;
  for (int i = 0; i < 8; ++i) vertices += (i ? "," : "") + corner(i, ",");
  for (const auto& f : kBoxFaces)
    indices += (indices.empty() ? "" : ",") + std::to_string(f[0]) + "," + std::to_string(f[1]) +
               "," + std::to_string(-f[2] - 1);
  return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n FBXHeaderVersion: 1003\n FBXVersion: "
         "7300\n}\n"
         "GlobalSettings:  {\n Version: 1000\n Properties70:  {\n"
         "  P: \"UpAxis\", \"int\", \"Integer\", \"\",1\n  P: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n"
         "  P: \"FrontAxis\", \"int\", \"Integer\", \"\",2\n  P: \"FrontAxisSign\", \"int\", \"Integer\", \"\",1\n"
         "  P: \"CoordAxis\", \"int\", \"Integer\", \"\",0\n  P: \"CoordAxisSign\", \"int\", \"Integer\", \"\",1\n"
         "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n }\n}\n"
         "Objects:  {\n Geometry: 1000, \"Geometry::box\", \"Mesh\" {\n  Vertices: *24 {\n   a: " +
         vertices + "\n  }\n  PolygonVertexIndex: *36 {\n   a: " + indices +
         "\n  }\n  GeometryVersion: 124\n }\n"
         " Model: 2000, \"Model::box\", \"Mesh\" {\n  Version: 232\n }\n}\n"
         "Connections:  {\n C: \"OO\",1000,2000\n C: \"OO\",2000,0\n}\n";
}

class Formats : public ::testing::TestWithParam<MeshText> {};

// In centimetres, with Y up: 1 m x 2 m high x 3 m.
TEST_P(Formats, AreReadWithTheirUnitsAndUpAxis) {
  const ScratchFolder scratch;
  write_file(scratch / GetParam().file, GetParam().text);
  write_file(scratch / "pack.lua",
             std::string("return pack { name = \"own\", assets = { { name = \"box\", mesh = \"") +
                 GetParam().file +
                 "\", units = \"cm\", up = \"y\", collision = \"hull\", material = \"timber\",\n"
                 " looks = { [\"Material.001\"] = \"timber\" } } } }\n");
  const Json box = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_TRUE(box.at("closed")) << box;
  EXPECT_NEAR(box.at("volume_m3"), 6, 1e-4);
  EXPECT_NEAR(box.at("mass_kg"), 3000, 0.05);
  EXPECT_NEAR(box.at("size_m")[0], 1, 1e-5);
  EXPECT_NEAR(box.at("size_m")[1], 3, 1e-5);
  EXPECT_NEAR(box.at("size_m")[2], 2, 1e-5);
  EXPECT_TRUE(box.at("errors").empty()) << box.at("errors");
}

INSTANTIATE_TEST_SUITE_P(Assets, Formats,
                         ::testing::Values(MeshText{"box.obj", obj_box()},
                                           MeshText{"box.stl", stl_box()},
                                           MeshText{"box.ply", ply_box()},
                                           MeshText{"box.gltf", gltf_box()},
                                           MeshText{"box.fbx", fbx_box()}),
                         [](const auto& test) {
                           return std::string(test.param.file).substr(4);
                         });

}  // namespace assets_formats_test
}  // namespace rubble::testing
