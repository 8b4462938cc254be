// The table in assets/README.md against the files.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/assets/obj_reader.h"

namespace rubble::test {
namespace readme_test {

std::string folder_of(const std::string& pack) {
  return std::string(RUBBLE_ASSETS_DIR) + "/" + pack + "/";
}

double density_of(const std::string& material) {  // unit: kg/m3; as in materials.lua
  const std::string text = read_text(std::string(RUBBLE_SOURCE_DIR) + "/assets/materials.lua");
  const std::size_t at = text.find("name = \"" + material + "\", density = ");
  EXPECT_NE(at, std::string::npos) << material;
  return std::stod(text.substr(text.find("density = ", at) + 10));
}

// The density that an asset has by its pack.lua: its own, or its material's.
double density_in(const std::string& pack_lua, const std::string& name) {
  const std::string text = read_text(pack_lua);
  const std::size_t at = text.find("name = \"" + name + "\"");
  const std::string entry = text.substr(at, text.find("tags = ", at) - at);
  const std::size_t own = entry.find("density = ");
  if (own != std::string::npos) return std::stod(entry.substr(own + 10));
  const std::size_t material = entry.find("material = \"") + 12;
  return density_of(entry.substr(material, entry.find('"', material) - material));
}

std::string calc_row(const std::string& folder, const std::string& name) {
  const TriangleMesh mesh = read_mesh(folder + name + ".lod0.obj");
  const Aabb box = mesh.bounds();
  const Vec3 size = box.max - box.min;
  const double mass = density_in(folder + "pack.lua", name) * calc_volume_properties(mesh).volume;
  std::string counts;
  for (int i = 0; i < 3; ++i) {
    const auto level = read_mesh(folder + name + ".lod" + std::to_string(i) + ".obj");
    counts += (i ? ", " : "") + std::to_string(level.triangles.size());
  }
  char text[200];
  std::snprintf(text, sizeof text, "|%s|%.2f x %.2f x %.2f|%.*f|%zu|%s|", name.c_str(),
                size.x, size.y, size.z, mass < 10 ? 2 : 0, mass,
                read_parts(folder + name + ".parts.obj").size(), counts.c_str());
  return text;
}

TEST(Readme, ListsThePiecesAsTheyAre) {
  const std::string readme = read_text(std::string(RUBBLE_SOURCE_DIR) + "/assets/README.md");
  for (const char* pack : {"concrete", "residential", "parking", "bridge", "victims"}) {
    for (const std::string& name : read_asset_names(folder_of(pack) + "pack.lua")) {
      const std::string row = calc_row(folder_of(pack), name);
      EXPECT_NE(readme.find(row + "\n"), std::string::npos) << "assets/README.md lacks\n" << row;
    }
  }
}

}  // namespace readme_test
}  // namespace rubble::test
