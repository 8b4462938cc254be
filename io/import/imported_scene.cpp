#include "io/import/imported_scene.h"

#include <algorithm>

#include "kernel/base/error.h"

namespace rubble {

void refuse_mesh(const std::string& path, const std::string& message, const std::string& hint, int line) {
  Diagnostic diagnostic;
  diagnostic.file = path;
  diagnostic.line = line;
  diagnostic.message = message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

void ImportedScene::note(const std::string& text) {
  if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
}

ImportedMesh& mesh_for(ImportedScene& scene, int material, int object) {
  if (scene.meshes.empty() || scene.meshes.back().material != material || scene.meshes.back().object != object) {
    scene.meshes.emplace_back();
    scene.meshes.back().material = material, scene.meshes.back().object = object;
  }
  return scene.meshes.back();
}

}  // namespace rubble
