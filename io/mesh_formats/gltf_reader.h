// glTF 2.0, with skins, morph targets, quantization, Draco and instances.
#pragma once

#include "io/import/imported_scene.h"

namespace rubble {

// The default scene of a .gltf or .glb file, in the pose of its nodes: joints bend skins, weights of morph targets move
// corners. Animations are not read. Files of glTF 1.0 are read by assimp. Throws InputError with the element.
ImportedScene read_gltf(const std::string& path);

}  // namespace rubble
