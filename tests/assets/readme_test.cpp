// The table in assets/README.md against the files.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/assets/obj_reader.h"

namespace rubble::test {
namespace {

const std::string kFolder = std::string(RUBBLE_ASSETS_DIR) + "/concrete/";

double density_of(const std::string& name) {  // unit: kg/m3
  if (name.find("rebar") != std::string::npos) return 7850;
  if (name.find("brick") != std::string::npos || name.find("block") != std::string::npos) {
    return 1900;
  }
  return 2400;
}

std::string calc_row(const std::string& name) {
  const TriangleMesh mesh = read_mesh(kFolder + name + ".lod0.obj");
  const Aabb box = mesh.bounds();
  const Vec3 size = box.max - box.min;
  const double mass = density_of(name) * calc_volume_properties(mesh).volume;
  std::string counts;
  for (int i = 0; i < 3; ++i) {
    const auto level = read_mesh(kFolder + name + ".lod" + std::to_string(i) + ".obj");
    counts += (i ? ", " : "") + std::to_string(level.triangles.size());
  }
  char text[200];
  std::snprintf(text, sizeof text, "| %s | %.2f x %.2f x %.2f | %.*f | %zu | %s |", name.c_str(),
                size.x, size.y, size.z, mass < 10 ? 2 : 0, mass,
                read_parts(kFolder + name + ".parts.obj").size(), counts.c_str());
  return text;
}

TEST(Readme, ListsThePiecesAsTheyAre) {
  const std::string readme = read_text(std::string(RUBBLE_SOURCE_DIR) + "/assets/README.md");
  for (const std::string& name : read_asset_names(kFolder + "pack.lua")) {
    const std::string row = calc_row(name);
    EXPECT_NE(readme.find(row + "\n"), std::string::npos) << "assets/README.md lacks\n" << row;
  }
}

}  // namespace
}  // namespace rubble::test
