// The files that a mesh consists of, and their hash.
#include "io/mesh/mesh_content.h"

#include <filesystem>

#include "kernel/base/hash.h"
#include "tests/io/mesh_files.h"

namespace rubble::test {

class MeshContentFiles : public MeshFiles {
 protected:
  std::string put(const std::string& file, const std::string& bytes) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / file).parent_path());
    write_text_file(folder_ / file, bytes);
    return folder_ / file;
  }
  // Whether the hash follows a change of the file beside.
  bool follows(const std::string& mesh, const std::string& beside, MeshContent content) {
    put(beside, "one");
    const std::string before = sha256_of_mesh(mesh, content);
    put(beside, "two");
    return sha256_of_mesh(mesh, content) != before;
  }
};

TEST_F(MeshContentFiles, OfOneFileHasItsHash) {
  for (const char* name : {"a.stl", "a.obj", "a.gltf", "a.glb", "a.dae"}) {
    const std::string mesh = put(name, "nothing of note");
    EXPECT_EQ(sha256_of_mesh(mesh, MeshContent::all), sha256_of_file(mesh)) << name;
  }
}

TEST_F(MeshContentFiles, AreBuffersAndImagesOfGltf) {
  const std::string json = R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "data:application/octet-stream;base64,AA=="}, {"uri": "b%20uf.bin"}],
                               "images": [{"uri": "wood.png"}]})";
  const std::string gltf = put("a.gltf", json);
  const auto four = [](std::size_t number) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += char(number >> 8 * i & 255);
    return bytes;
  };
  const std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
  const std::string glb = put("a.glb", "glTF" + four(2) + four(20 + padded.size()) + four(padded.size()) + "JSON" + padded);
  put("wood.png", "");
  for (const std::string& mesh : {gltf, glb}) {
    EXPECT_TRUE(follows(mesh, "b uf.bin", MeshContent::geometry)) << mesh;
    EXPECT_FALSE(follows(mesh, "wood.png", MeshContent::geometry)) << mesh;
    EXPECT_TRUE(follows(mesh, "wood.png", MeshContent::all)) << mesh;
  }
}

TEST_F(MeshContentFiles, AreMaterialsAndImagesOfObjAndCollada) {
  const std::string obj = put("a.obj", "mtllib my paint.mtl\nv 0 0 0\n");
  put("my paint.mtl", "newmtl a\r\nmap_Kd -s 1 1 1 wood.png\r\n");
  put("textures/wood.png", "");
  EXPECT_EQ(list_files_of_mesh(obj, MeshContent::all).size(), 2U);
  EXPECT_TRUE(follows(obj, "textures/wood.png", MeshContent::all));
  EXPECT_FALSE(follows(obj, "textures/wood.png", MeshContent::geometry));
  const std::string apart = put("b.obj", "mtllib materials/b.mtl # paint\n");
  put("materials/b.mtl", "newmtl b\nmap_Kd stone.png\n");
  EXPECT_TRUE(follows(apart, "materials/stone.png", MeshContent::all)) << "beside its library";
  const std::string dae = put("a.dae", "<image><!-- <init_from>none.png</init_from> --><init_from>./one.png</init_from></image><init_from><ref>two.png</ref></init_from>");
  put("one.png", ""), put("two.png", "");
  EXPECT_TRUE(follows(dae, "one.png", MeshContent::all));
  EXPECT_TRUE(follows(dae, "two.png", MeshContent::all));
}

}  // namespace rubble::test
