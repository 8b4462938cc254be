#include "tests/assets/obj_reader.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace rubble::test {
namespace {

struct Corner {
  int position = 0, normal = 0;
};

Corner read_corner(std::istream& line) {
  Corner corner;
  line >> corner.position;
  if (!line.eof() && line.peek() == '/') {
    line.ignore(2);
    line >> corner.normal;
  }
  return corner;
}

Vec3 read_vector(std::istream& line) {
  Vec3 v;
  line >> v.x >> v.y >> v.z;
  return v;
}

void read_face(std::istream& line, TriangleMesh& mesh, int first, const std::string& path) {
  std::array<std::uint32_t, 3> triangle{};
  for (std::uint32_t& v : triangle) {
    const Corner corner = read_corner(line);
    ASSERT_FALSE(line.fail()) << path;
    ASSERT_TRUE(corner.normal == 0 || corner.normal == corner.position) << path;
    v = static_cast<std::uint32_t>(corner.position - first);
    ASSERT_LT(v, mesh.positions.size()) << path;
  }
  mesh.triangles.push_back(triangle);
}

}  // namespace

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.good()) << "cannot read " << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TriangleMesh read_mesh(const std::string& path) {
  TriangleMesh mesh;
  std::istringstream file(read_text(path));
  for (std::string text; std::getline(file, text);) {
    std::istringstream line(text);
    std::string keyword;
    line >> keyword;
    if (keyword == "v") {
      mesh.positions.push_back(Vec3f(read_vector(line)));
    } else if (keyword == "vn") {
      mesh.normals.push_back(Vec3f(read_vector(line)));
    } else if (keyword == "usemtl") {
      mesh.surface_names.emplace_back();
      line >> mesh.surface_names.back();
    } else if (keyword == "f") {
      read_face(line, mesh, 1, path);
      mesh.surfaces.push_back(static_cast<std::uint8_t>(mesh.surface_names.size() - 1));
    }
  }
  return mesh;
}

std::vector<Part> read_parts(const std::string& path) {
  std::vector<Part> parts;
  int first = 1;
  std::istringstream file(read_text(path));
  for (std::string text; std::getline(file, text);) {
    std::istringstream line(text);
    std::string keyword;
    line >> keyword;
    if (keyword == "o") {
      if (!parts.empty()) first += static_cast<int>(parts.back().points.size());
      parts.emplace_back();
    } else if (keyword == "v") {
      parts.back().points.push_back(read_vector(line));
      parts.back().hull.positions.push_back(Vec3f(parts.back().points.back()));
    } else if (keyword == "f") {
      read_face(line, parts.back().hull, first, path);
    }
  }
  return parts;
}

std::vector<std::string> read_asset_names(const std::string& pack_lua) {
  std::vector<std::string> names;
  std::istringstream file(read_text(pack_lua));
  for (std::string line; std::getline(file, line);) {
    const std::string key = "      name = \"";
    if (line.rfind(key, 0) == 0)
      names.push_back(line.substr(key.size(), line.size() - key.size() - 2));
  }
  return names;
}

}  // namespace rubble::test
