// `rubble assets`: the bundled packs pass, and packs with mistakes do not.
#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace assets_test {

using Json = nlohmann::json;

Json check_json(const std::string& pack, int exit_code = 0) {
  const Outcome check = run_rubble("assets check --json " + pack);
  EXPECT_EQ(check.exit_code, exit_code) << check.err;
  return Json::parse(check.out);
}

class BundledPack : public ::testing::TestWithParam<std::string> {};

TEST_P(BundledPack, PassesItsCheck) {
  const Json report = check_json(GetParam());
  EXPECT_EQ(report.at("pack"), GetParam());
  for (const Json& asset : report.at("assets")) {
    const std::string name = asset.at("name");
    EXPECT_TRUE(asset.at("closed")) << name;
    EXPECT_TRUE(asset.at("errors").empty()) << name << ": " << asset.at("errors");
    EXPECT_TRUE(asset.at("warnings").empty()) << name << ": " << asset.at("warnings");
    EXPECT_GE(asset.at("thinnest_m"), 0.01) << name;
    EXPECT_LE(asset.at("most_corners"), 32) << name;
    EXPECT_GT(asset.at("mass_kg"), 0.5) << name;
    EXPECT_LT(asset.at("mass_kg"), 8000) << name;
  }
  for (const Json& tree : report.at("articulated")) {
    EXPECT_TRUE(tree.at("errors").empty()) << tree.at("name") << ": " << tree.at("errors");
    EXPECT_TRUE(tree.at("warnings").empty()) << tree.at("name") << ": " << tree.at("warnings");
    EXPECT_EQ(tree.at("joints").get<int>(), tree.at("links").get<int>() - 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Assets, BundledPack,
                         ::testing::Values("concrete", "residential", "parking", "bridge", "victims"),
                         [](const auto& test) { return test.param; });

// A cube of side `size` as an OBJ file; open: without its top.
std::string cube_obj(double size, bool open = false) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string(i >> axis & 1 ? size : 0.0);
    text += "\n";
  }
  text += "f 1 3 4 2\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
  return open ? text : text + "f 5 6 8 7\n";
}

std::string one_asset(const std::string& keys) {
  return "return pack { name = \"own\", assets = { { name = \"cube\", mesh = \"cube.obj\", " + keys +
         " } } }\n";
}

TEST(AssetsCheck, MeasuresACubeAgainstItsParts) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1));
  // A part that is a quarter of the cube: a quarter is covered, three quarters are not.
  write_file(scratch / "part.obj",
             "o a\nv 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nv 0.5 0.5 0\nv 0 0 1\nv 0.5 0 1\nv 0 0.5 1\n"
             "v 0.5 0.5 1\nf 1 3 4\nf 1 2 6\nf 2 4 8\nf 4 3 7\nf 3 1 5\nf 5 6 8\n");
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\", material = \"timber\""));
  const Json whole = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_NEAR(whole.at("volume_m3"), 1, 1e-6);
  EXPECT_NEAR(whole.at("mass_kg"), 500, 1e-3);
  EXPECT_NEAR(whole.at("parts_outside_mesh_m3"), 0, 1e-5);
  EXPECT_NEAR(whole.at("mesh_outside_parts_m3"), 0, 1e-5);
  write_file(scratch / "pack.lua", one_asset("collision = { parts = \"part.obj\" }"));
  const Json quarter = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_NEAR(quarter.at("parts_outside_mesh_m3"), 0, 1e-5);
  EXPECT_NEAR(quarter.at("mesh_outside_parts_m3"), 0.75, 0.01);
  EXPECT_FALSE(quarter.at("warnings").empty());
}

TEST(AssetsCheck, SaysThatAnOpenMeshHasNoVolumeOfItsOwn) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1, true));
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Json cube = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_FALSE(cube.at("closed"));
  EXPECT_NEAR(cube.at("volume_m3"), 1, 1e-5) << "of the hull";
  ASSERT_EQ(cube.at("warnings").size(), 1u);
  EXPECT_NE(cube.at("warnings")[0].get<std::string>().find("not closed"), std::string::npos);
}

// Two cubes on a third: joined ones may overlap, the two that are not must be apart.
std::string two_on_one(double apart, double joint_z) {
  const auto link = [&](const char* name, double x) {
    return std::string("{ asset = \"cube\", name = \"") + name + "\", on = \"base\", position = { " +
           std::to_string(x) + ", 0, 1 }, joint_position = { 0.5, 0.5, " + std::to_string(joint_z) +
           " } }, ";
  };
  return "return pack { name = \"own\", assets = { { name = \"cube\", mesh = \"cube.obj\", material = "
         "\"timber\" },\n{ name = \"tree\", links = { { asset = \"cube\", name = \"base\" }, " +
         link("a", 0) + link("b", apart) + "} } } }\n";
}

TEST(AssetsCheck, LooksAtArticulatedAssetsWhole) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1));
  write_file(scratch / "pack.lua", two_on_one(1.2, 1));
  const Json tree = check_json(scratch.path().string()).at("articulated")[0];
  EXPECT_EQ(tree.at("links"), 3);
  EXPECT_NEAR(tree.at("mass_kg"), 1500, 1e-2);
  EXPECT_NEAR(tree.at("size_m")[0], 2.2, 1e-5);
  EXPECT_NEAR(tree.at("size_m")[2], 2, 1e-5);
  EXPECT_TRUE(tree.at("errors").empty()) << tree;

  write_file(scratch / "pack.lua", two_on_one(0.7, 1));
  const Json overlap = check_json(scratch.path().string(), 1).at("articulated")[0];
  ASSERT_EQ(overlap.at("errors").size(), 1u);
  EXPECT_NE(overlap.at("errors")[0].get<std::string>().find("link 3 (cube) overlaps link 2 (cube)"),
            std::string::npos);

  write_file(scratch / "pack.lua", two_on_one(1.2, -0.5));
  const Json astray = check_json(scratch.path().string()).at("articulated")[0];
  EXPECT_FALSE(astray.at("warnings").empty()) << "the joint is 50 cm below the base";

  const Outcome show =
      run_rubble("assets show " + scratch.path().string() + " --out " + (scratch / "sheet.png"));
  EXPECT_EQ(show.exit_code, 0) << show.err;
}

TEST(AssetsCheck, FailsForDegenerateParts) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1));
  write_file(scratch / "part.obj", "o flat\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  write_file(scratch / "pack.lua", one_asset("collision = { parts = \"part.obj\" }"));
  const Json cube = check_json(scratch.path().string(), 1).at("assets")[0];
  EXPECT_FALSE(cube.at("errors").empty());
  const Outcome table = run_rubble("assets check " + scratch.path().string());
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_NE(table.out.find("error: cube: "), std::string::npos) << table.out;
}

// A box of 100 x 200 x 300 units, in the formats that people export; made by hand, so that what is
// read is what the format's description says.
struct MeshText {
  const char* file;
  std::string text;
};

constexpr int kBoxFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

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

// A table's legs: one hull would fill the space below it.
TEST(AssetsCheck, DecomposesAndKeepsThePartsOnDisk) {
  const ScratchFolder scratch;
  std::string obj;
  int first = 1;
  const auto box = [&](double x0, double y0, double z0, double x1, double y1, double z1) {
    for (int i = 0; i < 8; ++i)
      obj += "v " + std::to_string(i & 1 ? x1 : x0) + " " + std::to_string(i & 2 ? y1 : y0) + " " +
             std::to_string(i & 4 ? z1 : z0) + "\n";
    for (const auto& f : kBoxFaces)
      obj += "f " + std::to_string(f[0] + first) + " " + std::to_string(f[1] + first) + " " +
             std::to_string(f[2] + first) + "\n";
    first += 8;
  };
  box(0, 0, 0.7, 1.2, 0.8, 0.75);
  for (const double x : {0.0, 1.12})
    for (const double y : {0.0, 0.72}) box(x, y, 0, x + 0.08, y + 0.08, 0.7);
  write_file(scratch / "cube.obj", obj);
  const std::string cache = scratch / "cache";
  const auto check = [&](const std::string& collision) {
    write_file(scratch / "pack.lua", one_asset("collision = \"" + collision + "\""));
    const Outcome outcome = run_rubble("assets check --json " + scratch.path().string(),
                                       "RUBBLE_CACHE=" + cache);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out).at("assets")[0];
  };
  const Json hull = check("hull"), cut = check("decompose");
  EXPECT_GT(hull.at("parts_outside_mesh_m3"), 0.5);
  EXPECT_LT(cut.at("parts_outside_mesh_m3"), 0.01);
  EXPECT_LT(cut.at("mesh_outside_parts_m3"), 0.005);
  EXPECT_GE(cut.at("parts"), 5);
  EXPECT_EQ(cut.at("parts_farthest_from_mesh_m"), 0) << "boxes are cut without error";
  EXPECT_FALSE(hull.contains("parts_farthest_from_mesh_m"));

  // The second run reads what the first one kept; a damaged entry is noticed and made anew.
  std::vector<std::filesystem::path> entries;
  for (const auto& e : std::filesystem::recursive_directory_iterator(cache))
    if (e.is_regular_file()) entries.push_back(e.path());
  ASSERT_EQ(entries.size(), 1u);
  const std::string kept = read_file(entries[0]);
  EXPECT_EQ(check("decompose"), cut);
  std::string damaged = kept;
  damaged[damaged.size() / 2] ^= 1;
  write_file(entries[0], damaged);
  EXPECT_EQ(check("decompose"), cut);
  EXPECT_EQ(read_file(entries[0]), kept);
}

TEST(AssetsShow, DrawsEveryAssetOnASheet) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(0.4));
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome show =
      run_rubble("assets show " + scratch.path().string() + " --out " + (scratch / "sheet.png"));
  ASSERT_EQ(show.exit_code, 0) << show.err;
  const std::string png = read_file(scratch / "sheet.png");
  ASSERT_GT(png.size(), 5000u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
}

// Two boxes at a corner: one hull fills the corner, and the sheet of what collides shows it.
TEST(AssetsShow, DrawsThePartsThatCollide) {
  const ScratchFolder scratch;
  std::string l = "v 0 0 0\nv 1 0 0\nv 1 0 0.2\nv 0.2 0 0.2\nv 0.2 0 1\nv 0 0 1\n"
                  "v 0 0.3 0\nv 1 0.3 0\nv 1 0.3 0.2\nv 0.2 0.3 0.2\nv 0.2 0.3 1\nv 0 0.3 1\n"
                  "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\nf 7 9 8\nf 7 10 9\nf 7 11 10\nf 7 12 11\n";
  for (int i = 1; i <= 6; ++i) {
    const std::string a = std::to_string(i), b = std::to_string(i % 6 + 1);
    const std::string c = std::to_string(i + 6), d = std::to_string(i % 6 + 7);
    l += "f " + a + " " + c + " " + d + "\nf " + a + " " + d + " " + b + "\n";
  }
  write_file(scratch / "cube.obj", l);
  const auto show = [&](const std::string& collision, const std::string& option) {
    write_file(scratch / "pack.lua", one_asset("collision = \"" + collision + "\""));
    const std::string out = scratch / (collision + option + ".png");
    const Outcome shown = run_rubble("assets show " + scratch.path().string() + " --out " + out + " " + option);
    EXPECT_EQ(shown.exit_code, 0) << shown.err;
    return read_file(out);
  };
  const std::string mesh = show("hull", ""), hull = show("hull", "--collision");
  const std::string cut = show("decompose", "--collision");
  EXPECT_EQ(show("decompose", ""), mesh) << "without --collision the mesh is drawn";
  EXPECT_NE(hull, mesh);
  EXPECT_NE(cut, hull);
  const Outcome checked = run_rubble("assets check --json " + scratch.path().string());
  const Json asset = Json::parse(checked.out).at("assets")[0];
  EXPECT_EQ(asset.at("parts"), 2);
  EXPECT_NEAR(asset.at("parts_outside_mesh_m3"), 0, 1e-6);
}

// A thin wide bowl: no few convex parts follow it. The advice is another than the option that is set.
TEST(AssetsCheck, WarnsWherePartsHoldMuchMoreThanTheMesh) {
  const ScratchFolder scratch;
  std::string obj;
  const int rings = 4, sides = 16;
  for (const double radius : {1.0, 0.97})
    for (int i = 0; i <= rings; ++i)
      for (int k = 0; k < sides; ++k) {
        const double down = 1.5707963 * i / rings, round = 6.2831853 * k / sides;
        obj += "v " + std::to_string(radius * std::sin(down) * std::cos(round)) + " " +
               std::to_string(radius * std::sin(down) * std::sin(round)) + " " + std::to_string(-radius * std::cos(down)) + "\n";
      }
  const auto at = [&](int shell, int ring, int k) {
    return std::to_string((shell * (rings + 1) + ring) * sides + (ring == 0 ? 0 : k % sides) + 1);
  };
  const auto face = [&](const std::string& a, const std::string& b, const std::string& c) {
    if (a != b && b != c && c != a) obj += "f " + a + " " + b + " " + c + "\n";
  };
  for (int k = 0; k < sides; ++k) {
    for (int i = 0; i < rings; ++i) {
      face(at(0, i, k), at(0, i + 1, k + 1), at(0, i + 1, k)), face(at(0, i, k), at(0, i, k + 1), at(0, i + 1, k + 1));
      face(at(1, i, k), at(1, i + 1, k), at(1, i + 1, k + 1)), face(at(1, i, k), at(1, i + 1, k + 1), at(1, i, k + 1));
    }
    face(at(0, rings, k), at(0, rings, k + 1), at(1, rings, k + 1)), face(at(0, rings, k), at(1, rings, k + 1), at(1, rings, k));
  }
  write_file(scratch / "cube.obj", obj);
  write_file(scratch / "pack.lua", one_asset("collision = \"decompose\""));
  const Outcome outcome = run_rubble("assets check " + scratch.path().string());
  EXPECT_NE(outcome.out.find("% more than the mesh and stand out of it by up to"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("collision = { parts = FILE }"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("try collision"), std::string::npos) << outcome.out;
}

// In map coordinates: rounded to half a metre, another shape.
TEST(AssetsCheck, RefusesAMeshInMapCoordinates) {
  const ScratchFolder scratch;
  std::string obj;
  for (int i = 0; i < 8; ++i)
    obj += "v " + std::to_string(358123.25 + (i & 1)) + " " + std::to_string(4512345.75 + (i >> 1 & 1)) + " " +
           std::to_string(i >> 2) + "\n";
  for (const auto& f : kBoxFaces)
    obj += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " + std::to_string(f[2] + 1) + "\n";
  write_file(scratch / "cube.obj", obj);
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome outcome = run_rubble("assets check " + scratch.path().string());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("lies too far from its origin"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("subtract about (35812"), std::string::npos) << outcome.out;
}

// A ball of 1,200 corners.
TEST(AssetsCheck, SimplifiesAHullOfMoreCornersThanAPartMayHave) {
  const ScratchFolder scratch;
  std::string obj;
  const int rings = 30, sides = 40;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      const double z = 3.14159265358979 * (i + 0.5) / rings, round = 6.28318530717959 * k / sides;
      obj += "v " + std::to_string(0.5 * std::sin(z) * std::cos(round)) + " " + std::to_string(0.5 * std::sin(z) * std::sin(round)) +
             " " + std::to_string(0.5 * std::cos(z)) + "\n";
    }
  const auto at = [&](int i, int k) { return std::to_string(i * sides + k % sides + 1); };
  for (int k = 0; k < sides; ++k) {
    for (int i = 0; i + 1 < rings; ++i)
      obj += "f " + at(i, k) + " " + at(i + 1, k) + " " + at(i + 1, k + 1) + "\nf " + at(i, k) + " " + at(i + 1, k + 1) + " " +
             at(i, k + 1) + "\n";
    if (k > 1)
      obj += "f " + at(0, 0) + " " + at(0, k - 1) + " " + at(0, k) + "\nf " + at(rings - 1, 0) + " " + at(rings - 1, k) + " " +
             at(rings - 1, k - 1) + "\n";
  }
  write_file(scratch / "cube.obj", obj);
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome outcome = run_rubble("assets check --json " + scratch.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const Json ball = Json::parse(outcome.out).at("assets")[0];
  EXPECT_LE(ball.at("most_corners"), 1000);
  EXPECT_LT(ball.at("mesh_outside_parts_m3"), 0.01 * double(ball.at("volume_m3")));
  EXPECT_NE(ball.at("warnings").dump().find("more than the 1000 that a part may have"), std::string::npos);
}

// A drum of 530 sides, with more points than corners: each corner stands out by a millionth of its size.
TEST(AssetsCheck, SimplifiesAHullWhoseCornersHardlyStandOut) {
  const ScratchFolder scratch;
  std::string obj;
  const int rings = 10, sides = 530;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      char line[96];
      const double round = 6.28318530717959 * k / sides;
      std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", 0.5 * std::cos(round), 0.5 * std::sin(round), 0.1 * i);
      obj += line;
    }
  const auto at = [&](int i, int k) { return " " + std::to_string(i * sides + k % sides + 1); };
  std::string bottom = "f", top = "f";
  for (int k = 0; k < sides; ++k) {
    for (int i = 0; i + 1 < rings; ++i) obj += "f" + at(i, k) + at(i, k + 1) + at(i + 1, k + 1) + at(i + 1, k) + "\n";
    bottom += at(0, sides - k), top += at(rings - 1, k);
  }
  write_file(scratch / "cube.obj", obj + bottom + "\n" + top + "\n");
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome outcome = run_rubble("assets check --json " + scratch.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const Json drum = Json::parse(outcome.out).at("assets")[0];
  EXPECT_LE(drum.at("most_corners"), 1000);
  EXPECT_NE(drum.at("warnings").dump().find("its hull has 1060 corners"), std::string::npos) << drum.at("warnings");
}

TEST(Assets, AreFoundByTheNameOfABundledPack) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua",
             "return rubble.mission { packs = { \"parking\", \"bridge\" },\n"
             "  pile = { mix = { { asset = \"car_flat\" }, { asset = \"girder\" } } } }\n");
  EXPECT_EQ(run_rubble("check " + (scratch / "m.lua")).exit_code, 0);
  write_file(scratch / "m.lua", "return rubble.mission { packs = { \"parking_\" } }\n");
  const Outcome wrong = run_rubble("check " + (scratch / "m.lua"));
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("m.lua:1: packs[1]: unknown pack `parking_`: expected a bundled pack (bridge, concrete, "
                           "parking, residential, victims) or a folder with a pack.lua (did you mean `parking`?)"),
            std::string::npos)
      << wrong.err;
}

}  // namespace assets_test
}  // namespace rubble::testing
