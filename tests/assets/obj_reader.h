// A reader of the OBJ files that our generator writes, so that the tests look at the files and not
// at what the generator meant. (Reading through assimp is tested with the importer.)
#pragma once

#include <string>
#include <vector>

#include "kernel/base/mesh.h"

namespace rubble::test {

// Fails the test and returns an empty mesh when the file is missing or holds anything unexpected.
TriangleMesh read_mesh(const std::string& path);

struct Part {
  std::vector<Vec3> points;
  TriangleMesh hull;  // as written, triangulated
};
std::vector<Part> read_parts(const std::string& path);

// Names of the assets of a pack, in order, from its pack.lua.
std::vector<std::string> read_asset_names(const std::string& pack_lua);

std::string read_text(const std::string& path);

}  // namespace rubble::test
