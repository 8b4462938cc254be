#include "io/mesh_formats/scene_reader.h"

#include <filesystem>

#include "io/mesh_formats/ply_reader.h"

namespace rubble {

ImportedScene read_scene(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  if (extension == ".obj") return read_obj(path);
  if (extension == ".stl") return read_stl(path);
  if (extension == ".ply") return read_ply_scene(path);
  if (extension == ".gltf" || extension == ".glb") return read_gltf(path);
  if (extension == ".3mf") return read_3mf(path);
  return read_by_assimp(path);
}

}  // namespace rubble
