// Files that crash the library behind io/mesh/mesh_file.h.
#include <gtest/gtest.h>

#include "io/base/atomic_file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace hostile_mesh_test {

using test::ScratchFolder;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr char kGeometry[] =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array "
    "id=\"pa\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor "
    "source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
    "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
    "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles "
    "count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles>"
    "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">";
constexpr char kEnd[] =
    "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
    "</COLLADA>";

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::string mesh_error(const std::string& path) {
  try {
    load_mesh(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// Each of these ended the program by a signal.
TEST(HostileMeshes, AreErrorsThatNameTheFile) {
  ScratchFolder folder;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  write_text_file(folder / "two.obj", corners + "f 1 2\n");
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string vertices(36, '\0');
  write_text_file(folder / "corner.ply", header + vertices + std::string("\3\0\0\0\0\1\0\0\0\xff\xff\xff\x7e", 13));
  write_text_file(folder / "cut.ply", header + vertices + std::string("\xff\0\0\0\0\1\0\0\0", 9));
  write_text_file(folder / "self.dae", kGeometry +
                                           std::string("<node id=\"n\"><instance_geometry "
                                                       "url=\"#g\"/><instance_node url=\"#n\"/>"
                                                       "</node>") +
                                           kEnd);
  write_text_file(folder / "deep.dae", kGeometry + repeated("<node>", 100000) +
                                           "<instance_geometry url=\"#g\"/>" +
                                           repeated("</node>", 100000) + kEnd);
  for (const char* name : {"two.obj", "corner.ply", "cut.ply", "self.dae", "deep.dae"}) {
    const std::string error = mesh_error(folder / name);
    EXPECT_TRUE(contains(error, name)) << name << ": " << error;
    EXPECT_NE(error, "no error") << name;
  }
}

}  // namespace hostile_mesh_test
}  // namespace rubble
